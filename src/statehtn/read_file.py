"""Files read in pieces, so that limits hold: a pipe may never begin, a device never end, a file not fit into memory."""

from __future__ import annotations

import os
import select
from collections.abc import Iterator

from statehtn.errors import InputError
from statehtn.limits import Limits
from statehtn.streams import own_descriptor

PIECE = 2**20  # bytes
MILLISECONDS = 50
"""Between two looks at the limits while nothing comes."""


def read_pieces(name: str | os.PathLike[str], limits: Limits = Limits()) -> Iterator[bytes]:
    """Yield the content of a file; limits hold, and Ctrl-C, also while a pipe has nothing to give.

    Args:
        name: a file, a pipe, a device, or a name of a stream that this process has open, such as `/dev/stdin`.
        limits: for time and memory.

    Raises:
        OSError: as `open` does.
        ValueError: no file can have such a name.
        LimitReached: a limit was reached.
    """
    own = own_descriptor(name)
    # Opened so, a pipe without a writer does not wait here, where nobody would look at the clock.
    descriptor = os.open(name, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC) if own is None else os.dup(own)
    try:
        poll = select.poll()
        poll.register(descriptor, select.POLLIN)
        while True:
            limits.check()
            if poll.poll(MILLISECONDS):
                try:
                    piece = os.read(descriptor, PIECE)
                except BlockingIOError:  # somebody else has read it
                    continue
                if not piece:
                    return
                yield piece
    finally:
        os.close(descriptor)


def read_named(title: str, name: str | os.PathLike[str], limits: Limits = Limits()) -> bytes:
    """Return the whole content of a file, which `title` stands for in messages.

    Raises:
        InputError: the file cannot be read.
        LimitReached: a limit was reached.
    """
    try:
        return b"".join(read_pieces(name, limits))
    except OSError as error:
        raise InputError(f"cannot read {title}: {error.strerror or error}") from None
    except ValueError:
        raise InputError(f"cannot read {title}: no file can have a name with a null character") from None
