"""From the bytes of a file to tokens: parentheses and words as they are written, with their places on demand.

A token is known by its index; line and column are worked out only when an error or a warning asks for them, so that
large files stay cheap.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator
from itertools import islice
from os import PathLike, fspath

from statehtn.errors import InputError, Place
from statehtn.hddl.spelling import UNSEEN
from statehtn.limits import Limits
from statehtn.read_file import read_pieces

MAX_NESTING = 200
"""Open parentheses at one point of a file; formulas are read and evaluated recursively, so this must stay well below
Python's recursion limit. Benchmarks need about ten."""

MAX_SECTION = 2_000_000
"""Tokens in one section other than `:init`, which is read without building nested lists."""

MAX_MESSAGE = 1000
"""Characters of a message."""

CHUNK = 1 << 16
_COMMENT = re.compile(r";[^\n]*")
_TOKEN = re.compile(r"[()]|[^\s()][^\s()?]*(?:\?+(?=[\s()]|\Z))?")  # a ? begins a variable, unless it ends a word
_BREAK = re.compile(r"[\s()]")
_LONG_WORD = re.compile(r"[^\s']{64,}")
_TOKEN_OR_COMMENT = re.compile(r"([()]|[^\s();][^\s();?]*(?:\?+(?=[\s();]|\Z))?)|;[^\n]*")
_GLUED = re.compile(r"\?(?<=[^\s()]\?)(?=[^\s()])")
_FOREIGN = re.compile(f"[,{UNSEEN}]")


class Source:
    """The tokens of one file, and the sections that they form.

    Args:
        text: the whole text of the file.
        file: the file's name in messages.
        limits: checked every 64 kB, and by those who read long sections.

    Attributes:
        tokens: parentheses and words, comments left out.
        sections: for every group directly inside `(define ...)` the index of its `(` and the index after its `)`.
        glued: the variables before which a space is missing, as in `at?x`.

    Raises:
        InputError: the text is empty, is not one balanced `(define ...)`, is nested too deeply, or has commas or
            characters that are not seen outside of comments.
    """

    __slots__ = ("_finder", "_offsets", "file", "glued", "limits", "sections", "text", "tokens")

    def __init__(self, text: str, file: str, limits: Limits) -> None:
        self.file = file
        self.limits = limits
        self.text = text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text
        self.tokens: list[str] = []
        self.sections: list[tuple[int, int]] = []
        self.glued: list[int] = []
        self._offsets = array("Q")
        self._finder = (match.start() for match in _TOKEN_OR_COMMENT.finditer(self.text) if match.lastindex)
        self._tokenise()

    def place(self, index: int) -> Place:
        """Return where a token stands; an index past the last token means the end of the file."""
        missing = index + 1 - len(self._offsets)
        if missing > 0:
            self._offsets.extend(islice(self._finder, missing))
        return self._place_at(self._offsets[index] if index < len(self._offsets) else len(self.text))

    def _place_at(self, offset: int) -> Place:
        line_start = self.text.rfind("\n", 0, offset) + 1
        return Place(self.file, self.text.count("\n", 0, offset) + 1, offset - line_start + 1)

    def error(self, message: str, index: int) -> InputError:
        """Return an error about the token at an index."""
        return InputError(concise(message), self.place(index))

    def _tokenise(self) -> None:
        depth = 0
        tokens, sections = self.tokens, self.sections
        start = 0
        for chunk in self._chunks():
            self.limits.check()
            for index, token in enumerate(chunk, len(tokens)):
                if token == "(":
                    depth += 1
                    if depth == 2:
                        start = index
                    elif depth == 1 and index:
                        raise self._trailing(index)
                    elif depth > MAX_NESTING:
                        raise self.error(
                            f"more than {MAX_NESTING} parentheses are open here; is one not closed?", index
                        )
                elif token == ")":
                    depth -= 1
                    if depth == 1:
                        self._check_section(start, index)
                        sections.append((start, index + 1))
                    elif depth < 0:
                        raise self._trailing(index) if index else self.error("expected '(define', found ')'", index)
                elif depth < 2 and not (index == 1 and token.lower() == "define"):
                    raise self._stray(token, index, depth)
            tokens += chunk
            if depth > 1 and len(tokens) - start > MAX_SECTION and tokens[start + 1].lower() != ":init":
                raise self.error(f"this section has more than {MAX_SECTION} words; is a ')' missing?", start)
        if not tokens:
            raise InputError(
                "the file is empty; expected '(define (domain ...' or '(define (problem ...'", self.place(0)
            )
        if depth:
            raise self._unclosed(depth)

    def _chunks(self) -> Iterator[list[str]]:
        """Yield the tokens piece by piece, equal words as the same object."""
        text = _COMMENT.sub("", self.text) if ";" in self.text else self.text
        if _FOREIGN.search(text):
            raise self._foreign()
        if "?" in text and _GLUED.search(text):
            self.glued = self._glued()
        words: dict[str, str] = {}
        start = 0
        while start < len(text):
            match = _BREAK.search(text, start + CHUNK)
            end = match.start() if match else len(text)
            chunk = _TOKEN.findall(text, start, end)
            yield list(map(words.setdefault, chunk, chunk))
            start = end

    def _foreign(self) -> InputError:
        """Return the error about the first character that has no business in the text."""
        words = (match for match in _TOKEN_OR_COMMENT.finditer(self.text) if match.lastindex)
        word, found = next((word, found) for word in words if (found := _FOREIGN.search(word[0])))
        place = self._place_at(word.start() + found.start())
        if found[0] == ",":
            return InputError("a comma has no meaning in HDDL; expected spaces between names", place)
        return InputError(f"the character U+{ord(found[0]):04X} cannot be seen and has no meaning in HDDL", place)

    def _glued(self) -> list[int]:
        starts = (match.start() for match in _TOKEN_OR_COMMENT.finditer(self.text) if match.lastindex)
        return [index for index, start in enumerate(starts) if _GLUED.match(self.text, start)]

    def _check_section(self, start: int, end: int) -> None:
        """Refuse an empty section at once: a large file of parentheses ends here and not in memory."""
        if start == 1:
            raise self.error("expected 'define' after the first parenthesis, found '('", start)
        if end == start + 1:
            raise self.error("expected a section such as '(:action ...)', found '()'", start)

    def _trailing(self, index: int) -> InputError:
        return self.error(
            "expected the end of the file, as '(define' was closed before; is there a ')' too many?", index
        )

    def _stray(self, token: str, index: int, depth: int) -> InputError:
        if index == 0 or (index == 1 and depth == 1):
            return self.error(
                f"expected '(define (domain ...' or '(define (problem ...', found '{shortened(token)}'", index
            )
        if depth == 0:
            return self._trailing(index)
        return self.error(f"expected a section in parentheses, found '{shortened(token)}'", index)

    def _unclosed(self, depth: int) -> InputError:
        """Say which parenthesis is open; a section inside another one tells best where the mistake is."""
        count = "one '(' is" if depth == 1 else f"{depth} '(' are"
        opened: list[int] = []
        for index, token in enumerate(self.tokens):
            if token == "(":
                if len(opened) > 1 and self._starts_section(index + 1):
                    word = self.tokens[index + 1]
                    return self.error(
                        f"unbalanced parentheses: {count} never closed; '({word}' stands inside another section, "
                        f"so a ')' is probably missing before it",
                        index,
                    )
                opened.append(index)
            elif token == ")":
                opened.pop()
        return self.error(f"unbalanced parentheses: {count} never closed, the last of them this one", opened[-1])

    def _starts_section(self, index: int) -> bool:
        return index < len(self.tokens) and self.tokens[index].lower() in (
            ":action",
            ":method",
            ":task",
            ":predicates",
            ":init",
        )


def read_text(path: str | PathLike[str], limits: Limits = Limits()) -> str:
    """Return the text of a file.

    Raises:
        InputError: the file cannot be read, is binary or is not UTF-8.
        LimitReached: a limit was reached.
    """
    file = fspath(path)
    pieces: list[bytes] = []
    for piece in read_pieces(file, limits):
        pieces.append(piece)
        if b"\0" in piece:  # perhaps a device without an end
            break
    data = b"".join(pieces)
    if (nul := data.find(b"\0")) >= 0:
        raise InputError("the file is binary (a NUL byte), expected HDDL text", _place_of_byte(file, data, nul))
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        place = _place_of_byte(file, data, error.start)
        raise InputError(
            f"the file is not UTF-8 text (byte 0x{data[error.start]:02x}), expected HDDL text", place
        ) from None


def shortened(word: str) -> str:
    """Return a word for a message, cut where it is long."""
    return word if len(word) <= 60 else f"{word[:60]}..."


def concise(message: str) -> str:
    """Return a message without the rest of words and lists that are too long to read."""
    message = _LONG_WORD.sub(lambda match: shortened(match[0]), message)
    return message if len(message) <= MAX_MESSAGE else f"{message[:MAX_MESSAGE]}..."


def _place_of_byte(file: str, data: bytes, offset: int) -> Place:
    line_start = data.rfind(b"\n", 0, offset) + 1
    return Place(file, data.count(b"\n", 0, offset) + 1, offset - line_start + 1)
