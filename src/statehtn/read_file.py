"""Files read in pieces, so that limits hold: a pipe may never begin, a device never end, a file not fit into memory."""

from __future__ import annotations

import math
import os
import select
import stat
from collections.abc import Iterator

from statehtn.errors import InputError
from statehtn.limits import Limits
from statehtn.streams import own_descriptor

PIECE = 2**20  # bytes
MOST_UNBOUNDED = 2**28
"""Bytes of what is no regular file: a pipe or a device may have no end."""
MILLISECONDS = 50
"""Between two looks at the limits while nothing comes."""


def read_pieces(name: str | os.PathLike[str], limits: Limits = Limits()) -> Iterator[bytes]:
    """Yield the content of a file; limits hold, and Ctrl-C, also while a pipe has nothing to give.

    Args:
        name: a file, a pipe, a device, or a name of a stream that this process has open, such as `/dev/stdin`.
        limits: for time and memory.

    Raises:
        InputError: the file cannot be read, or is a pipe or a device that goes on and on.
        LimitReached: a limit was reached.
    """
    title = f"'{os.fspath(name)}'"
    try:
        yield from _pieces(name, title, limits)
    except OSError as error:
        raise InputError(f"cannot read {title}: {error.strerror or error}") from None
    except ValueError:
        raise InputError(f"cannot read {title}: no file can have a name with a null character") from None


def _pieces(name: str | os.PathLike[str], title: str, limits: Limits) -> Iterator[bytes]:
    own = own_descriptor(name)
    # Opened so, a pipe without a writer does not wait here, where nobody would look at the clock.
    descriptor = os.open(name, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC) if own is None else os.dup(own)
    try:
        left = math.inf if stat.S_ISREG(os.fstat(descriptor).st_mode) else MOST_UNBOUNDED
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
                left -= len(piece)
                if left < 0:
                    raise InputError(
                        f"cannot read {title}: it is no regular file, and more than {MOST_UNBOUNDED // 2**20} MiB come "
                        f"out of it; does it end?"
                    )
                yield piece
    finally:
        os.close(descriptor)


def read_whole(name: str | os.PathLike[str], limits: Limits = Limits()) -> bytearray:
    """Return the whole content of a file; as `read_pieces`."""
    whole = bytearray()
    for piece in read_pieces(name, limits):
        whole += piece
    return whole
