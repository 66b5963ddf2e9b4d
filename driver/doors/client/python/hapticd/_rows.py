# SPDX-License-Identifier: MIT
"""The black box of a running daemon: the newest rows of every stream. It is read and not mapped, because the kernel kills a
program whose mapped file is cut."""
from __future__ import annotations

import json
import operator
import os
import struct
import weakref
from dataclasses import dataclass
from typing import Any, Optional

from ._error import CLOSED, HapticdError, Named, known

try:
    import numpy
except ImportError:  # without numpy the row classes below are used
    numpy = None  # type: ignore[assignment]

_HEADER_AT = 512  # see recording.md, "Layout for other writers and readers"
_HEADER = struct.Struct("<24sIIIIQQQ")
_CLOSED_AT = _HEADER_AT + 32  # the member `closed` of the header
_CLOSED = struct.Struct("<I")
_STREAM = struct.Struct("<16sIIQQ")
_BLOCK = struct.Struct("<IIQ")
_COUNT = struct.Struct("<Q")
_BLOCK_MAGIC = 0x4B4C4248
_INDEX_NODE = 0xFFFFFFFF
_CODES = {"f8": "d", "f4": "f", "u8": "Q", "u4": "I", "i4": "i"}
_TRIES = 1000  # the writer goes round its ring in seconds
_TEXT = "s"  # s96: UTF-8, filled up with zeros to 96 bytes


def _whole(name: str, value: Any) -> int:
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{name}={value!r}: expected a whole number of rows, 0 or more") from None


def _format(type_name: str) -> str:
    """Returns the name that numpy has for a type. Its texts lose the zeros at their end."""
    return type_name.upper() if type_name.startswith(_TEXT) else "<" + type_name


def _value(type_name: str, data: bytearray, at: int) -> Any:
    if type_name.startswith(_TEXT):  # bytes, as numpy gives them
        return bytes(data[at:at + int(type_name[len(_TEXT):])]).rstrip(b"\0")
    return struct.unpack_from("<" + _CODES[type_name], data, at)[0]


@dataclass(frozen=True)
class Column:
    """One value of a row: its name, type (f8, f4, u8, u4, i4; s96: UTF-8 of at most 95 bytes), place in the row in bytes,
    unit and meaning."""

    name: str
    type: str
    offset: int
    unit: str
    doc: str

    def fits(self, row_bytes: int) -> bool:
        """Tells whether this package can read it: it is in the row, and has a type that is known."""
        texts = self.type.startswith(_TEXT) and self.type[len(_TEXT):].isdigit()
        size = int(self.type[len(_TEXT):]) if texts else struct.calcsize("<" + _CODES[self.type]) if self.type in _CODES else row_bytes + 1
        return 0 <= self.offset <= row_bytes - size


class Row(tuple):
    """A row, if there is no numpy: a tuple whose numbers can also be read by name, `row["t"]`."""

    places: dict[str, int] = {}

    def __getitem__(self, key: Any) -> Any:
        return tuple.__getitem__(self, self.places[key] if isinstance(key, str) else key)


class Rows(list):
    """Rows, if there is no numpy: a list whose columns can be read by name, `rows["t"]`."""

    def __getitem__(self, key: Any) -> Any:
        return [row[key] for row in self] if isinstance(key, str) else list.__getitem__(self, key)


class _File:
    """The bytes of a file that others may change and cut."""

    def __init__(self, file: str) -> None:
        self._fd = os.open(file, os.O_RDONLY | os.O_CLOEXEC)
        weakref.finalize(self, os.close, self._fd)
        self.size = os.fstat(self._fd).st_size
        self.closed = False  # nothing more may be read but whether the daemon has ended

    def read(self, at: int, size: int) -> bytes:
        if self.closed:
            raise HapticdError(CLOSED, "closed")
        data = b""
        while len(data) < size:
            more = os.pread(self._fd, size - len(data), at + len(data))
            if not more:
                raise HapticdError("the black box of the daemon was cut by another program\n  fix: start the daemon again, then connect again",
                                   "damaged")
            data += more
        return data

    def unpacked(self, form: struct.Struct, at: int) -> tuple[Any, ...]:
        return form.unpack(self.read(at, form.size))

    def ended(self) -> bool:
        data = os.pread(self._fd, _CLOSED.size, _CLOSED_AT)
        return len(data) == _CLOSED.size and _CLOSED.unpack(data)[0] != 0


class Stream:
    """The rows of one stream. Rows are numbered from 0; the newest `capacity` are kept."""

    def __init__(self, file: _File, number: int, name: str, row_bytes: int, capacity: int, rows_at: int,
                 columns: list[Column]) -> None:
        self.number, self.name, self.row_bytes, self.capacity = number, name, row_bytes, capacity
        self.columns = columns
        self._file, self._rows_at = file, rows_at
        self._count_at = _HEADER_AT + _HEADER.size + number * _STREAM.size + 24
        self._row = type("Row", (Row,), {"places": Named("column", {c.name: i for i, c in enumerate(columns)})})
        self.dtype = None
        if numpy is not None:
            self.dtype = numpy.dtype({"names": [c.name for c in columns], "formats": [_format(c.type) for c in columns],
                                      "offsets": [c.offset for c in columns], "itemsize": row_bytes})

    @property
    def written(self) -> int:
        """The number of rows written so far, which is also the number of the next row."""
        count = again = -1
        for _ in range(_TRIES):  # the kernel may copy a number byte by byte while the servo stores it
            count, again = again, self._file.unpacked(_COUNT, self._count_at)[0]
            if count == again:
                break
        return again

    def _kept(self, first: int, written: int) -> int:
        # the slot after the newest row may already be half overwritten
        return max(first, written - self.capacity + 1, 0)

    def read(self, first: int, most: Optional[int] = None) -> tuple[int, Any]:
        """Returns rows from number `first` on, at most `most`. Rows that are no longer kept are left out, so the
        result is the number of the first returned row, and the rows. It never waits."""
        first, most = _whole("first", first), None if most is None else _whole("most", most)
        if first < 0 or (most is not None and most < 0):
            raise ValueError(f"rows are counted from 0: read({first}, {most}); the newest n are last(n)")
        for _ in range(_TRIES):
            written = self.written
            first = min(self._kept(first, written), written)
            count = written - first if most is None else min(most, written - first)
            data = self._copy(first, count)
            if self._kept(first, self.written) == first:
                return first, self._parsed(data, count)
        return first, self._parsed(bytearray(), 0)

    def last(self, count: int) -> Any:
        """Returns the newest rows, oldest first."""
        if (count := _whole("last", count)) < 0:
            raise ValueError(f"last={count}: expected how many of the newest rows, 0 or more")
        return self.read(max(self.written - count, 0))[1]

    def _copy(self, first: int, count: int) -> bytearray:
        at = first % self.capacity
        before_the_end = min(count, self.capacity - at)
        begin = self._rows_at + at * self.row_bytes
        data = bytearray(self._file.read(begin, before_the_end * self.row_bytes))
        if before_the_end < count:
            data += self._file.read(self._rows_at, (count - before_the_end) * self.row_bytes)
        return data

    def _parsed(self, data: bytearray, count: int) -> Any:
        if numpy is not None:
            return numpy.frombuffer(data, self.dtype, count)
        return Rows(self._row(_value(c.type, data, row * self.row_bytes + c.offset)
                              for c in self.columns) for row in range(count))


class BlackBox:
    """A black box: its description and its streams."""

    def __init__(self, file: str) -> None:
        try:
            self._file = _File(file)
        except OSError as error:
            raise HapticdError(f"cannot read {file}: {error.strerror}\n  fix: start a daemon with hapticd run; its group may read it", "damaged") from None
        try:
            self._read()
        except (OSError, struct.error, ValueError, KeyError, TypeError, IndexError, OverflowError, RecursionError) as error:
            raise HapticdError(f"{file}: the black box cannot be understood ({error!r}); its daemon may be of another version, or still starting",
                               "damaged") from None
        except HapticdError as error:
            raise HapticdError(f"{file}: {error}", "damaged") from None

    def _read(self) -> None:
        magic, count, ring, _, _, about_at, about_bytes, blocks_at = self._file.unpacked(_HEADER, _HEADER_AT)
        if not magic.startswith(b"hapticd-recording/1") or not ring:
            raise HapticdError("is not a black box that this version of the package can read", "damaged")
        self.about: dict[str, Any] = json.loads(self._file.read(about_at, min(about_bytes, self._file.size)))
        places = self._rows_of(blocks_at, count)
        self.streams: dict[str, Stream] = Named("stream")
        for number in range(count):
            name, row_bytes, capacity, _, _ = self._file.unpacked(
                _STREAM, _HEADER_AT + _HEADER.size + number * _STREAM.size)
            text = name.rstrip(b"\0").decode()
            columns = [known(Column, column) for column in self.about["columns"][text]]
            at, size = places[number]
            if capacity < 2 or row_bytes < 1 or size < capacity * row_bytes:
                raise HapticdError("the black box is damaged: it has no room for its rows", "damaged")
            self.streams[text] = Stream(self._file, number, text, row_bytes, capacity, at,
                                        [column for column in columns if column.fits(row_bytes)])

    def _rows_of(self, at: int, count: int) -> dict[int, tuple[int, int]]:
        places: dict[int, tuple[int, int]] = {}
        while len(places) < count and at + _BLOCK.size <= self._file.size:
            magic, stream, size = self._file.unpacked(_BLOCK, at)
            if magic != _BLOCK_MAGIC:
                break
            at += _BLOCK.size
            if stream != _INDEX_NODE:
                places[stream] = at, min(size, self._file.size - at)
            at += size
        if len(places) < count:
            raise HapticdError("the black box is damaged: it lacks the rows of a stream", "damaged")
        return places

    def ended(self) -> bool:
        """Returns whether the daemon has noted here that it ended in order."""
        return self._file.ended()

    def close(self) -> None:
        self._file.closed = True
