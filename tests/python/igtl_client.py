# SPDX-License-Identifier: AGPL-3.0-or-later
"""A client of OpenIGTLink made of struct and sockets alone, as other people write them."""

import socket
import struct
import time

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


def header(version, kind, device, size, crc):
    return struct.pack(">H12s20sQQQ", version, kind.encode(), device.encode(), 0, size, crc)


def message_1(kind, device, content, crc=None):
    """Header 1; `crc` in place of the right one."""
    return header(1, kind, device, len(content), crc64(content) if crc is None else crc) + content


def message(kind, device, content, meta=()):
    """Header 2, with metadata behind the content."""
    index = struct.pack(">H", len(meta))
    data = b""
    for key, value in meta:
        index += struct.pack(">HHI", len(key), 3, len(value))
        data += key.encode() + value.encode()
    body = struct.pack(">HHII", 12, len(index), len(data), 1) + content + index + data
    return header(2, kind, device, len(body), crc64(body)) + body


class Client:
    def __init__(self, port, receive_buffer=0):
        self.socket = socket.socket()
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(30)
        self.socket.connect(("127.0.0.1", port))

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
        head = self._take(58)
        version, kind, device, _, size, crc = struct.unpack(">H12s20sQQQ", head)
        body = self._take(size)
        self.raw = head + body  # of the last message
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

    def is_closed_within(self, seconds):
        """Whether the server closes; what it still sends is thrown away."""
        end = time.monotonic() + seconds
        try:
            while time.monotonic() < end:
                if not self.socket.recv(1 << 16):
                    return True
        except (ConnectionError, socket.timeout) as error:
            return isinstance(error, ConnectionError)
        return False

    def wait_for(self, kind, version=0):
        end = time.monotonic() + 60
        while time.monotonic() < end:
            got = self.read()
            if got[1] == kind and got[0] >= version:
                return got
        raise AssertionError(f"no {kind} came")
