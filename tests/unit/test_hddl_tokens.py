"""From bytes to tokens: places, comments, and files that are not HDDL at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from statehtn.errors import InputError, Place
from statehtn.hddl import read_hddl
from statehtn.hddl.expressions import CHECK_EVERY, parse_group
from statehtn.hddl.tokens import MAX_MESSAGE, MAX_NESTING, Source, read_text
from statehtn.limits import LimitReached, Limits

LIMITS = Limits()
FIFTY_MEGABYTES = 50_000_000


def source(text: str) -> Source:
    return Source(text, "d.hddl", LIMITS)


def test_words_are_as_written_and_comments_disappear() -> None:
    read = source("(Define (DOMAIN D) ; (not here\n\t(:Types a;b\n))")
    assert read.tokens == ["(", "Define", "(", "DOMAIN", "D", ")", "(", ":Types", "a", ")", ")"]
    assert read.sections == [(2, 6), (6, 10)]


def test_places_count_from_one_and_look_past_comments() -> None:
    read = source("(define ; one (two\n  (domain d)\n)")
    assert [str(read.place(i)) for i in (0, 1, 2, 4, 6)] == [
        "d.hddl:1:1",
        "d.hddl:1:2",
        "d.hddl:2:3",
        "d.hddl:2:11",
        "d.hddl:3:1",
    ]
    assert read.place(99) == Place("d.hddl", 3, 2)


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_every_kind_of_line_end(newline: str) -> None:
    read = source(newline.join(("(define ; a comment", "(domain d))")))
    assert str(read.place(2)) == "d.hddl:2:1"


def test_words_and_comments_across_chunks() -> None:
    words = " ".join(f"w{i}" for i in range(60_000))
    comment = "; " + "x (" * 100_000
    read = source(f"(define (domain d) {comment}\n (:types {words}))")
    assert read.tokens[8:-2] == words.split()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "d.hddl:1:1: the file is empty"),
        ("; nothing\n", "d.hddl:2:1: the file is empty"),
        ("(define (domain d)", "d.hddl:1:1: unbalanced parentheses: one '(' is never closed"),
        ("(define (domain d)\n (:task a\n (:action b))", "d.hddl:3:2: unbalanced parentheses"),
        ("(define (domain d)))", "d.hddl:1:20: expected the end of the file"),
        ("(define (domain d)) (x)", "d.hddl:1:21: expected the end of the file"),
        ("(define (domain d)) x", "d.hddl:1:21: expected the end of the file"),
        (")", "d.hddl:1:1: expected '(define', found ')'"),
        ("hello", "d.hddl:1:1: expected '(define (domain"),
        ("(domain d)", "d.hddl:1:2: expected '(define (domain"),
        ("((define))", "d.hddl:1:2: expected 'define' after the first parenthesis"),
        ("(define (domain d) x)", "d.hddl:1:20: expected a section in parentheses, found 'x'"),
        ("(define (domain d) ())", "d.hddl:1:20: expected a section"),
    ],
)
def test_what_is_not_a_define(text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        source(text)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    "text",
    [
        "(" * FIFTY_MEGABYTES,
        ")" * FIFTY_MEGABYTES,
        "()" * (FIFTY_MEGABYTES // 2),
        "(define (domain d)" + "()" * (FIFTY_MEGABYTES // 2),
        "(define (domain d) (:predicates " + "()" * (FIFTY_MEGABYTES // 2),
    ],
    ids=["opening", "closing", "pairs", "pairs inside", "pairs in a section"],
)
def test_fifty_megabytes_of_parentheses_end_at_once(text: str) -> None:
    with pytest.raises(InputError):
        Source(text, "d.hddl", Limits.starting_now(time_limit=120))


def test_nesting_as_deep_as_allowed_and_deeper(tmp_path: Path) -> None:
    def domain(depth: int) -> str:
        """Wrap an atom into `not`s, so that `depth` parentheses are open; three of them are around the precondition."""
        nots = depth - 3
        return f"(define (domain d) (:predicates (p)) (:action a :precondition {'(not ' * nots}(p){')' * nots}))"

    (tmp_path / "p.hddl").write_text("(define (problem p) (:htn :subtasks ()))")
    (tmp_path / "d.hddl").write_text(domain(MAX_NESTING))
    assert read_hddl(tmp_path / "d.hddl", tmp_path / "p.hddl").domain.actions
    (tmp_path / "d.hddl").write_text(domain(MAX_NESTING + 1))
    with pytest.raises(InputError, match="200 parentheses are open"):
        read_hddl(tmp_path / "d.hddl", tmp_path / "p.hddl")


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read '.*missing\.hddl': No such file"):
        read_text(tmp_path / "missing.hddl")
    with pytest.raises(InputError, match="cannot read '.*': Is a directory"):
        read_text(tmp_path)
    with pytest.raises(InputError, match="cannot read"):
        read_text("a\0b")


@pytest.mark.parametrize(
    ("data", "place", "message"),
    [
        (b"(define\n \0", ":2:2: ", "binary"),
        (b"(define\n ;\xff\xfe", ":2:3: ", "not UTF-8 text (byte 0xff)"),
        (b"\x7fELF\x02\x01\x01\0", ":1:8: ", "binary"),
    ],
)
def test_binary_files(tmp_path: Path, data: bytes, place: str, message: str) -> None:
    path = tmp_path / "d.hddl"
    path.write_bytes(data)
    with pytest.raises(InputError) as caught:
        read_text(path)
    assert place in str(caught.value)
    assert message in str(caught.value)


def test_a_byte_order_mark_is_skipped(tmp_path: Path) -> None:
    path = tmp_path / "d.hddl"
    path.write_bytes(b"\xef\xbb\xbf(define (domain caf\xc3\xa9))")
    assert source(read_text(path)).tokens[4] == "café"


def test_limits_are_checked() -> None:
    with pytest.raises(LimitReached):
        Source("(define (domain d))", "d.hddl", Limits(deadline=0.0))


def test_limits_are_checked_inside_a_long_section() -> None:
    read = source(f"(define (domain d) (:types {'t ' * (CHECK_EVERY + 1)}))")
    assert len(parse_group(read, 6).items) == CHECK_EVERY + 2
    read.limits = Limits(deadline=0.0)
    with pytest.raises(LimitReached):
        parse_group(read, 6)


@pytest.mark.parametrize("text", ["9" * 5000, "a " * 5000])
def test_messages_leave_out_what_is_too_long(text: str) -> None:
    """A file may be one long word; found by damaging files at random."""
    message = str(source("(define (domain d))").error(f"expected a fact, found '{text}'", 0))
    assert message.startswith("d.hddl:1:1: expected a fact, found '")
    assert "..." in message
    assert len(message) < MAX_MESSAGE + 100
