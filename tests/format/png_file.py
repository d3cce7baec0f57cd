"""Reads PNG files of 8-bit RGB, and checks their checksums: for tests, beside the product's own."""
from dataclasses import dataclass, field
import struct
import zlib


@dataclass
class Picture:
    width: int
    height: int
    rows: list  # bytes each, 3 a pixel
    chunks: list
    texts: dict = field(default_factory=dict)

    def pixel(self, x, y):
        return tuple(self.rows[y][3 * x : 3 * x + 3])

    def world(self):
        """x0, y0, x1, y1 in metres of a picture from above."""
        return tuple(float(number) for number in self.texts["drtv:world"].split(","))

    def at(self, x_m, y_m):
        x0, y0, x1, y1 = self.world()
        return self.pixel(int((x_m - x0) / (x1 - x0) * self.width), int((y1 - y_m) / (y1 - y0) * self.height))


def unfiltered(data, stride):
    """Rows of a PNG's bytes, 3 bytes a pixel (PNG specification, 9.2)."""
    rows, above = [], bytes(stride)
    for start in range(0, len(data), stride + 1):
        kind, row = data[start], bytearray(data[start + 1 : start + 1 + stride])
        for n in range(stride):
            left, up, corner = (row[n - 3], above[n], above[n - 3]) if n >= 3 else (0, above[n], 0)
            guess = left + up - corner
            paeth = min((left, up, corner), key=lambda byte: abs(guess - byte))
            row[n] = row[n] + (0, left, up, (left + up) // 2, paeth)[kind] & 255
        rows.append(bytes(row))
        above = rows[-1]
    return rows


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is no PNG file"
    at, chunks, packed, texts = 8, [], b"", {}
    width = height = 0
    while at < len(data):
        (size,) = struct.unpack_from(">I", data, at)
        kind, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + size]
        assert struct.unpack_from(">I", data, at + 8 + size)[0] == zlib.crc32(kind + body), kind
        chunks.append(kind.decode())
        if kind == b"IHDR":
            width, height, *rest = struct.unpack(">IIBBBBB", body)
            assert rest == [8, 2, 0, 0, 0], rest
        elif kind == b"IDAT":
            packed += body
        elif kind == b"tEXt":
            key, text = body.split(b"\0", 1)
            texts[key.decode("latin-1")] = text.decode("latin-1")
        at += 12 + size
    rows = zlib.decompress(packed)
    assert len(rows) == height * (3 * width + 1)
    return Picture(width, height, unfiltered(rows, 3 * width), chunks, texts)
