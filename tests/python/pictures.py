# SPDX-License-Identifier: AGPL-3.0-or-later
import struct
import zlib

import numpy as np


def read_png(data):
    """8- and 16-bit PNG by hand, so that the tests need no picture library."""
    at, compressed, width, height, depth = 8, b"", 0, 0, 0
    while at < len(data):
        (size,) = struct.unpack(">I", data[at : at + 4])
        kind, chunk = data[at + 4 : at + 8], data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, depth = struct.unpack(">IIB", chunk[:9])
        if kind == b"IDAT":
            compressed += chunk
        at += 12 + size
    raw, step = zlib.decompress(compressed), depth // 8
    row, rows, before = width * step, [], np.zeros(width * step, np.int64)
    for y in range(height):
        kind = raw[y * (row + 1)]
        line = np.frombuffer(raw, np.uint8, row, y * (row + 1) + 1).astype(np.int64)
        out = np.zeros(row, np.int64)
        for x in range(row):
            left = out[x - step] if x >= step else 0
            corner = before[x - step] if x >= step else 0
            up = before[x]
            if kind == 4:
                p = left + up - corner
                near = min((abs(p - left), 0), (abs(p - up), 1), (abs(p - corner), 2))[1]
                guess = (left, up, corner)[near]
            else:
                guess = (0, left, up, (left + up) // 2)[kind]
            out[x] = (line[x] + guess) % 256
        rows.append(out)
        before = out
    pixels = np.array(rows, np.uint8)
    return pixels if step == 1 else pixels.reshape(height, width, 2).view(">u2")[..., 0]
