# SPDX-License-Identifier: AGPL-3.0-or-later
"""A client of OpenIGTLink made of struct and sockets alone, as other people write them, against the tool."""

import os
import socket
import struct
import subprocess
import time

import numpy as np
import pytest

POLYNOMIAL = 0x42F0E1EBA9EA3693


def table():
    entries = []
    for byte in range(256):
        crc = byte << 56
        for _ in range(8):
            crc = ((crc << 1) ^ (POLYNOMIAL if crc >> 63 else 0)) & (2**64 - 1)
        entries.append(crc)
    return entries


TABLE = table()


def crc64(data):
    crc = 0
    for byte in data:
        crc = ((crc << 8) & (2**64 - 1)) ^ TABLE[(crc >> 56) ^ byte]
    return crc


def message(kind, device, content, meta=()):
    """Header 2, with metadata behind the content."""
    index = struct.pack(">H", len(meta))
    data = b""
    for key, value in meta:
        index += struct.pack(">HHI", len(key), 3, len(value))
        data += key.encode() + value.encode()
    body = struct.pack(">HHII", 12, len(index), len(data), 1) + content + index + data
    head = struct.pack(">H12s20sQQQ", 2, kind.encode(), device.encode(), 0, len(body), crc64(body))
    return head + body


class Client:
    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=30)

    def send(self, *arguments):
        self.socket.sendall(message(*arguments))

    def _take(self, size):
        data = b""
        while len(data) < size:
            piece = self.socket.recv(size - len(data))
            assert piece, "the server closed the connection"
            data += piece
        return data

    def read(self):
        version, kind, device, _, size, crc = struct.unpack(">H12s20sQQQ", self._take(58))
        body = self._take(size)
        kind, device = kind.rstrip(b"\0").decode(), device.rstrip(b"\0").decode()
        if kind != "IMAGE" or version == 2:  # a picture's sum takes a tenth of a second here
            assert crc64(body) == crc
        meta = {}
        if version == 2:
            extension, index_size, data_size, _ = struct.unpack(">HHII", body[:12])
            end = len(body) - index_size - data_size
            at, place = end + 2, end + index_size
            for _ in range(struct.unpack(">H", body[end : end + 2])[0] if index_size else 0):
                key, _, value = struct.unpack(">HHI", body[at : at + 8])
                meta[body[place : place + key].decode()] = body[place + key : place + key + value].decode()
                at, place = at + 8, place + key + value
            body = body[extension:end]
        return version, kind, device, body, meta

    def wait_for(self, kind, version=0):
        end = time.monotonic() + 60
        while time.monotonic() < end:
            got = self.read()
            if got[1] == kind and got[0] >= version:
                return got
        raise AssertionError(f"no {kind} came")


@pytest.fixture
def port(tool, simple):
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        number = probe.getsockname()[1]
    server = subprocess.Popen(
        [tool, "serve", "-j", str(simple), "--input", "injection", "--igtl", str(number),
         "--prefix", f"artus-py-{os.getpid()}-", "--json"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(600):
        try:
            socket.create_connection(("127.0.0.1", number), timeout=1).close()
            break
        except OSError:
            time.sleep(0.1)
    yield number
    server.terminate()
    assert server.wait(30) == 0


def test_a_hello_with_metadata_is_understood_and_commands_are_answered(port):
    client = Client(port)
    status = struct.pack(">Hq20s", 1, 0, b"None") + b"hello\0"
    client.send("STATUS", "Slicer", status, [("Version", "5.6.2"), ("Host", "here")])
    command = b'<Command Name="Version"/>'
    content = struct.pack(">I20sHI", 4711, b"Version", 3, len(command)) + command
    client.send("COMMAND", "Slicer", content, [("a", "b")])
    version, _, device, body, meta = client.wait_for("RTS_COMMAND")
    assert version == 2 and device == "Slicer"
    assert meta == {"Status": "SUCCESS"}
    number, name, _, size = struct.unpack(">I20sHI", body[:30])
    assert number == 4711 and name.rstrip(b"\0") == b"Version" and len(body) == 30 + size
    assert b"<Result>true</Result>" in body


def test_pictures_have_pixels_place_and_forces(port):
    client = Client(port)
    client.send("GET_STATUS", "x", b"")
    client.wait_for("STATUS")
    _, _, device, body, meta = client.wait_for("IMAGE", version=2)
    assert device == "Image_Reference"
    assert float(meta["Force_N"]) >= 0 and meta["HapticRate_Hz"] == "1000"
    _, components, scalar, _, _, width, height, depth = struct.unpack(">HBBBBHHH", body[:12])
    assert (components, scalar, width, height, depth) == (1, 3, 400, 400, 1)
    matrix = np.array(struct.unpack(">12f", body[12:60])).reshape(4, 3).T
    assert np.allclose(np.linalg.norm(matrix[:, :3], axis=0), 0.1, atol=1e-6)  # mm a pixel
    grey = np.frombuffer(body, np.uint8, offset=72)
    assert grey.size == 400 * 400 and grey.std() > 10
