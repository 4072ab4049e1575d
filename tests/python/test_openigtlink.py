# SPDX-License-Identifier: AGPL-3.0-or-later
"""A client of OpenIGTLink made of struct and sockets alone, as other people write them, against the tool."""

import contextlib
import os
import shutil
import socket
import struct
import subprocess
import time

import numpy as np
import pytest
from igtl_client import Client, crc64, header, message, message_1

def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_until_it_listens(number, server):
    for _ in range(600):
        assert server.poll() is None, "the program ended"
        try:
            socket.create_connection(("127.0.0.1", number), timeout=1).close()
            return
        except OSError:
            time.sleep(0.1)


# What is asked here does not depend on how often and by how many threads a picture is drawn.
FEW_PICTURES = ["--image-rate", "10", "--threads", "1"]


@contextlib.contextmanager
def serving(tool, simple):
    number = free_port()
    server = subprocess.Popen(
        [tool, "serve", "-j", str(simple), "--rigid", "--input", "injection", "--igtl", str(number),
         "--prefix", f"artus-py-{number}-", "--json", *FEW_PICTURES],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_until_it_listens(number, server)
    yield number, server
    assert server.poll() is None, "a client ended the session"
    server.terminate()
    assert server.wait(30) == 0


@pytest.fixture(scope="module")
def session(tool, simple):
    """One session for all clients that leave it as it was: what one of them does is no other's matter."""
    with serving(tool, simple) as running:
        yield running


@pytest.fixture
def port(session):
    number, server = session
    yield number
    assert server.poll() is None, "a client ended the session"


@pytest.fixture
def own_port(tool, simple):
    with serving(tool, simple) as (number, _):
        yield number


# What a connector of 3D Slicer says at once, STATUS with header 2 and metadata, and a COMMAND of it: byte
# for byte as the protocol has them, written down field by field with their check values.
HELLO = bytes.fromhex(
    "0002 535441545553000000000000 536c696365720000000000000000000000000000"  # 2, STATUS, Slicer
    "0000000000000000 0000000000000052 4ee39fd663da9101"  # no time, 82 bytes, check value
    "000c 000a 0000000c 00000001"  # extension of 12, index of 10, data of 12, number 1
    "0001 0000000000000000 4e6f6e6500000000000000000000000000000000"  # OK, 0, None
    "48656c6c6f2066726f6d20536c6963657200"  # Hello from Slicer
    "0001 0007 0003 00000005 56657273696f6e 352e362e32")  # Version: 5.6.2
COMMAND = bytes.fromhex(
    "0002 434f4d4d414e440000000000 536c696365720000000000000000000000000000"  # 2, COMMAND, Slicer
    "0000000000000000 000000000000005a df0a94abff8b24df"  # no time, 90 bytes, check value
    "000c 000a 0000000c 00000001"
    "00001267 56657273696f6e00000000000000000000000000 0003 0000001a"  # 4711, Version, ASCII, 26
    "3c436f6d6d616e64204e616d653d2256657273696f6e22202f3e"  # <Command Name="Version" />
    "0001 0006 0003 00000006 4f726967696e 536c69636572")  # Origin: Slicer


def test_the_bytes_of_slicers_hello_and_command_are_answered_byte_for_byte(port):
    client = Client(port)
    client.socket.sendall(HELLO + COMMAND)
    client.wait_for("RTS_COMMAND")
    version = subprocess.run([os.environ["ARTUS_TOOL"], "--version"], capture_output=True, text=True)
    text = f"<Command><Result>true</Result><Message>{version.stdout.strip()}</Message></Command>"
    content = struct.pack(">I20sHI", 4711, b"Version", 3, len(text)) + text.encode()
    expected = message("RTS_COMMAND", "Slicer", content, [("Status", "SUCCESS")])
    got = client.raw
    assert got[:34] == expected[:34] and got[42:] == expected[42:]  # all but the time
    assert abs(struct.unpack(">Q", got[34:42])[0] / 2**32 - time.time()) < 300


def test_bytes_may_come_one_by_one(port):
    client = Client(port)
    client.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    for byte in HELLO + COMMAND:
        client.socket.sendall(bytes([byte]))
    assert client.wait_for("RTS_COMMAND")[4] == {"Status": "SUCCESS"}


def test_a_client_of_header_one_gets_header_one(port):
    client = Client(port)
    client.socket.sendall(message_1("GET_STATUS", "old", b"") + message_1("STT_SENSOR", "", b""))
    assert client.wait_for("STATUS")[0] == 1
    for kind, size in (("TRANSFORM", 48), ("SENSOR", 10 + 24)):
        version, _, _, body, meta = client.wait_for(kind)
        assert version == 1 and len(body) == size and not meta
    command = struct.pack(">I20sHI", 3, b"Version", 3, 0)
    client.socket.sendall(message_1("COMMAND", "old", command))
    assert client.wait_for("RTS_COMMAND")[0] == 1


def test_an_unknown_type_is_passed_over(port):
    client = Client(port)
    client.send("POLYDATA", "x", bytes(100_000))
    client.socket.sendall(message_1("CLIENTINFO", "plus", b"<ClientInfo/>") + COMMAND)
    assert client.wait_for("RTS_COMMAND")


@pytest.mark.parametrize("bad", [
    message_1("TRANSFORM", "ProbeToReference", bytes(48), crc=crc64(bytes(48)) ^ 1),
    message_1("COMMAND", "x", b"12345678", crc=0),
    message_1("COMMAND", "x", b"short"),
    header(2, "STATUS", "x", 2**40, 0),
    header(7, "STATUS", "x", 30, 0) + bytes(30),
    message("STATUS", "x", b"")[:58] + struct.pack(">HHII", 12, 9999, 9999, 1),
    b"GET / HTTP/1.1\r\nHost: localhost:18944\r\nUser-Agent: curl/7.88.1\r\nAccept: */*\r\n\r\n",
], ids=["wrong sum", "no sum", "cut", "terabyte", "version 7", "lying extension", "browser"])
def test_who_lies_is_closed_alone(port, bad):
    honest, liar = Client(port), Client(port)
    liar.socket.sendall(bad)
    liar.socket.sendall(COMMAND)
    assert liar.is_closed_within(20)
    honest.socket.sendall(COMMAND)
    assert honest.wait_for("RTS_COMMAND")[4] == {"Status": "SUCCESS"}


def test_many_clients_are_served_while_some_read_nothing(port):
    stalled = [Client(port, 4096) for _ in range(8)]
    clients = [Client(port) for _ in range(24)]
    for client in clients:
        client.send("GET_STATUS", "x", b"")
    for client in clients:
        assert client.wait_for("STATUS")
    times = {client.wait_for("IMAGE")[2] for client in clients}
    assert times == {"Image_Reference"}
    for client in stalled:
        client.socket.close()
    clients[0].wait_for("IMAGE")


def test_more_clients_than_it_takes_are_turned_away(own_port):
    clients = [Client(own_port) for _ in range(64)]
    clients[63].socket.sendall(COMMAND)
    assert clients[63].wait_for("RTS_COMMAND")
    assert Client(own_port).is_closed_within(20)
    clients[0].socket.sendall(COMMAND)
    assert clients[0].wait_for("RTS_COMMAND")


def test_what_cannot_be_done_is_answered_with_the_reason(port):
    client = Client(port)
    client.wait_for("IMAGE")  # the session runs
    for name, value, why in [("Scenario", "shoulder", "scenario"), ("Gain", "loud", "Value from"),
                             ("SelfDestruct", "", "is not known")]:
        xml = f'<Command Name="{name}" Value="{value}" />'.encode()
        content = struct.pack(">I20sHI", 1, name.encode(), 3, len(xml)) + xml
        client.send("COMMAND", "Slicer", content)
        meta = client.wait_for("RTS_COMMAND")[4]
        assert meta["Status"] == "FAIL" and why in meta["ErrorMessage"], name


def ask(client, name, value):
    xml = f"<Command Name='{name}' Value='{value}' />".encode()
    client.send("COMMAND", "Slicer", struct.pack(">I20sHI", 1, name.encode(), 3, len(xml)) + xml)
    return client.wait_for("RTS_COMMAND")[4]


def height_of(client):
    return struct.unpack(">H", client.wait_for("IMAGE", version=2)[3][8:10])[0]


def test_a_scenario_of_artus_begins_by_command(tool, simple):
    number = free_port()
    server = subprocess.Popen(
        [tool, "serve", "-j", str(simple), "--rigid", "--input", "igtl", "--probe-hold-ms", "60000", "--igtl",
         str(number), "--prefix", f"artus-ps-{os.getpid()}-", "--json", *FEW_PICTURES],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    wait_until_it_listens(number, server)
    client = Client(number)
    looks_down = np.diag([-1.0, -1.0, 1.0]).T.ravel().tolist() + [0.0, 0.0, 0.0]  # where gel has its skin
    client.send("TRANSFORM", "ProbeToReference", struct.pack(">12f", *looks_down))
    assert height_of(client) == 400
    refused = ask(client, "Scenario", "/etc/passwd")
    assert refused["Status"] == "FAIL" and "gel-steep" in refused["ErrorMessage"]
    assert ask(client, "Scenario", "gel-steep")["Status"] == "SUCCESS"
    assert any(height_of(client) == 500 for _ in range(400))  # this scenario's depth is 50 mm
    assert ask(client, "Scenario", "gel-hold")["Status"] == "SUCCESS"
    assert any(height_of(client) == 400 for _ in range(400))
    server.terminate()
    assert server.stdout.read().count(b'"frames"') == 3  # one report a session
    assert server.wait(30) == 0


@pytest.mark.skipif(shutil.which("xvfb-run") is None, reason="xvfb-run is not installed")
def test_the_trainer_takes_a_scenario_between_attempts_and_knobs_in_one(tool, tmp_path):
    number = free_port()
    script = tmp_path / "steps.script"
    script.write_text("page who\nwait 2\nkey ENTER\npage pseudonym\nkey ENTER\npage what\nwait 60\n"
                      "page briefing\nkey ENTER\npage attempt\nawait picture 20\nwait 3\nkey F10\n"
                      "page end\nkey ESCAPE\n")
    trainer = subprocess.Popen(
        ["xvfb-run", "-a", tool, "train", "--records", str(tmp_path / "records.db"), "--script", str(script),
         "--language", "en", "--igtl", str(number), "--width", "640", "--height", "480"],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    wait_until_it_listens(number, trainer)
    client = Client(number)
    client.socket.sendall(HELLO)
    assert "who trains" in ask(client, "Scenario", "gel-steep")["ErrorMessage"]
    assert "does not run" in ask(client, "Gain", "10")["ErrorMessage"]
    while ask(client, "Scenario", "gel-steep")["Status"] != "SUCCESS":
        time.sleep(0.1)
    assert height_of(client) == 500  # the attempt at it, whose picture is 50 mm deep
    assert ask(client, "Gain", "10")["Status"] == "SUCCESS"
    assert "free" in ask(client, "Scenario", "gel-hold")["ErrorMessage"]
    assert trainer.wait(60) == 0, trainer.stderr.read()


def test_a_scenario_that_cannot_start_leaves_the_session_as_it_was(tool, simple):
    number = free_port()
    server = subprocess.Popen(
        [tool, "serve", "-j", str(simple), "--rigid", "--input", "injection", "--injection", "2", "--igtl",
         str(number), "--prefix", f"artus-pf-{os.getpid()}-", "--json", *FEW_PICTURES],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    wait_until_it_listens(number, server)
    client = Client(number)
    client.socket.sendall(HELLO)
    assert height_of(client) == 400
    assert ask(client, "Scenario", "gel-steep")["Status"] == "SUCCESS"
    end = time.monotonic() + 2.5
    while time.monotonic() < end:
        assert height_of(client) == 400
    server.terminate()
    assert b"no injection 2" in server.stderr.read()  # gel plans none
    assert server.wait(30) == 0


@pytest.mark.skipif(shutil.which("xvfb-run") is None, reason="xvfb is not there")
def test_the_window_is_seen_and_turned_from_outside(tool, simple, tmp_path):
    number = free_port()
    window = subprocess.Popen(
        ["xvfb-run", "-a", tool, "view", "-j", str(simple), "--rigid", "--igtl", str(number), "--prefix",
         f"artus-pw-{os.getpid()}-", "--layout", str(tmp_path / "layout.ini")],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True)
    try:
        wait_until_it_listens(number, window)
        client = Client(number)
        client.socket.sendall(HELLO)
        first = client.wait_for("IMAGE", version=2)
        assert struct.unpack(">HHH", first[3][6:12]) == (400, 400, 1)
        xml = b'<Command Name="Depth" Value="60" />'
        client.send("COMMAND", "Slicer", struct.pack(">I20sHI", 1, b"Depth", 3, len(xml)) + xml)
        assert client.wait_for("RTS_COMMAND")[4]["Status"] == "SUCCESS"
        for _ in range(400):  # the knob turns in the window's next picture, the tables follow
            height = struct.unpack(">H", client.wait_for("IMAGE")[3][8:10])[0]
            if height == 600:
                break
        assert height == 600
    finally:
        os.killpg(window.pid, 15)
        window.wait(60)


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


NEWTON, METRE, PASCAL = 0x02C4 << 48, 0x0044 << 48, 0x0304 << 48
CUBIC_METRE, CUBIC_METRE_PER_SECOND = 0x004C << 48, 0x004C3F << 40


def test_a_thumb_is_answered_with_force_pressure_flow_and_volumes(tool, simple):
    number = free_port()
    server = subprocess.Popen(
        [tool, "serve", "-j", str(simple), "--rigid", "--input", "igtl", "--needle-hold-ms", "1000", "--syringe-ml", "50", "--igtl",
         str(number), "--prefix", f"artus-pt-{os.getpid()}-", "--json", *FEW_PICTURES],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_until_it_listens(number, server)
    client = Client(number)
    client.send("STT_SENSOR", "", b"")
    in_the_air = [1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0, 0, 0, -500.0]
    asked = {"ThumbForce": (NEWTON, 1), "PlungerTravel": (METRE, 1), "SyringePressure": (PASCAL, 2),
             "SyringeFlow": (CUBIC_METRE_PER_SECOND, 1), "SyringeVolume": (CUBIC_METRE, 2)}
    got = {}

    def ready():
        return set(got) == set(asked) and got["ThumbForce"][0] > 14.9 and got["SyringeVolume"][0] > 1e-7

    end = time.monotonic() + 60
    while not ready() and time.monotonic() < end:
        client.send("TRANSFORM", "NeedleToReference", struct.pack(">12f", *in_the_air))
        client.send("SENSOR", "Plunger", struct.pack(">BBQd", 1, 0, NEWTON, 15.0))
        for _ in range(8):
            _, kind, device, body, _ = client.read()
            if kind == "SENSOR" and device in asked:
                count, _, unit = struct.unpack(">BBQ", body[:10])
                assert (unit, count) == asked[device]
                got[device] = struct.unpack(f">{count}d", body[10:])
    assert ready(), got
    area = np.pi * 26.7e-3**2 / 4  # the barrel of 50 ml glides with 5 N
    assert abs(got["SyringePressure"][0] - 10 / area) < 0.02 * 10 / area
    assert abs(got["SyringePressure"][1]) < 1  # the needle is in the air
    assert 0 < got["SyringeFlow"][0] < 2e-6 and got["SyringeVolume"][1] == 0
    assert abs(got["PlungerTravel"][0] * area - got["SyringeVolume"][0]) < 1e-6
    server.terminate()
    assert server.wait(30) == 0
