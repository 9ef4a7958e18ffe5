"""What goes out over UDP: the sentences, their signs and checksums, positions, and that nothing stops a simulation."""

import re
import socket
from datetime import UTC, datetime
from math import atan2, cos, degrees, hypot, pi, radians, sin

import numpy as np
import pytest

import ogilvie as og
from ogilvie.frames import euler_rate_matrix, rotation_matrix
from ogilvie.post.broadcast import UdpSender, json_line
from ogilvie.post.geodesy import FLATTENING, SEMI_MAJOR, TangentPlane, earth_centred, geographic
from ogilvie.post.nmea import SENTENCES, Nmea
from ogilvie.post.steady_frame import SteadyFrame
from ogilvie.units import deg, knot

START = datetime(2024, 2, 28, 23, 59, 58, tzinfo=UTC)
OSLO = (59.9 * deg, 10.7 * deg)


def parse_nmea(block: bytes) -> dict[str, list[str]]:
    """The fields of each sentence by its name, after a check of form and checksum."""
    found = {}
    for line in block.decode("ascii").splitlines(keepends=True):
        match = re.fullmatch(r"\$([A-Z]{5}),([^*$\r\n]*)\*([0-9A-F]{2})\r\n", line)
        assert match, line
        assert len(line) <= 82, line
        total = 0
        for letter in line[1 : line.index("*")]:
            total ^= ord(letter)
        assert total == int(match[3], 16), line
        found[match[1]] = match[2].split(",")
    return found


def place(fields: list[str]) -> tuple[float, float]:
    """Latitude and longitude of four fields, deg."""
    lat, ns, lon, ew = fields
    assert re.fullmatch(r"\d{4}\.\d{6}", lat)
    assert re.fullmatch(r"\d{5}\.\d{6}", lon)
    latitude, longitude = int(lat[:2]) + float(lat[2:]) / 60.0, int(lon[:3]) + float(lon[3:]) / 60.0
    return latitude * {"N": 1, "S": -1}[ns], longitude * {"E": 1, "W": -1}[ew]


def sent(eta=(0.0,) * 6, nu=(0.0,) * 6, time=0.0, **options) -> dict[str, list[str]]:
    return parse_nmea(Nmea(**{"start": START, "origin": OSLO} | options)(og.State(eta=eta, nu=nu, time=time)))


# sentences


def test_all_sentences_and_their_fields():
    found = sent([10.0, 20.0, -0.25, 0.1, 0.02, 0.5], [5.0, 0.5, 0.1, 0.01, 0.02, 0.03], time=3.25)
    names = ["GPGGA", "GPRMC", "GPVTG", "HEHDT", "TIROT", "YXXDR", "PASHR"]
    assert list(found) == names
    assert [len(found[n]) for n in names] == [14, 12, 9, 2, 2, 12, 11]  # the fields that the standard gives each
    assert found["GPGGA"][0] == found["GPRMC"][0] == found["PASHR"][0] == "000001.250"
    assert found["GPRMC"][8] == "290224"
    assert found["GPGGA"][8:10] == ["-0.250", "M"]
    kinds, units, quantities = (found["YXXDR"][i::4] for i in (0, 2, 3))
    assert (kinds, units, quantities) == (["A", "A", "D"], ["D", "D", "M"], ["PTCH", "ROLL", "HEAV"])


@pytest.mark.parametrize(
    ("x_axis", "psi_deg", "heading"),
    [
        ("east", 0, 90),
        ("east", 90, 0),
        ("east", -90, 180),
        ("east", 180, 270),
        ("north", 0, 0),
        ("north", 90, 270),
        ("north", -1, 1),
    ],
)
def test_heading_and_course(x_axis, psi_deg, heading):
    """Anticlockwise from x here, clockwise from North there; ahead the course is the heading, abeam 90 deg beside it."""
    eta = [0, 0, 0, 0, 0, psi_deg * deg]
    found = sent(eta, [4.0, 0, 0, 0, 0, 0], x_axis=x_axis)
    assert float(found["HEHDT"][0]) == float(found["PASHR"][1]) == heading
    assert float(found["GPVTG"][0]) == float(found["GPRMC"][7]) == pytest.approx(heading)
    assert float(found["GPVTG"][4]) == pytest.approx(4.0 / knot, abs=1e-3)
    assert float(found["GPVTG"][6]) == pytest.approx(14.4, abs=1e-3)
    to_port = sent(eta, [0, 4.0, 0, 0, 0, 0], x_axis=x_axis)
    assert float(to_port["GPVTG"][0]) == pytest.approx((heading - 90) % 360)


def test_signs_of_attitude():
    """Roll: port side up is positive in both; pitch: bow down here, bow up there; heave: up."""
    eta = np.array([0, 0, 1.5, 3.0 * deg, 2.0 * deg, 0])
    found = sent(eta)
    port, bow = rotation_matrix(*eta[3:]) @ [0, 1, 0], rotation_matrix(*eta[3:]) @ [1, 0, 0]
    assert port[2] > 0 > bow[2]
    x = dict(zip(found["YXXDR"][3::4], map(float, found["YXXDR"][1::4]), strict=True))
    assert x == {"PTCH": -2.0, "ROLL": 3.0, "HEAV": 1.5}
    assert found["PASHR"][3:6] == ["+3.00", "-2.00", "+1.50"]


@pytest.mark.parametrize("attitude", [(0.0, 0.0), (0.3, -0.2)])
def test_rate_of_turn_is_the_rate_of_the_heading(attitude):
    """Positive to starboard, from the headings before and after, at any attitude."""
    eta, nu, h = np.array([0, 0, 0, *attitude, 0.4]), np.array([0, 0, 0, 0.1, -0.05, 0.08]), 1e-5
    step = np.concatenate([np.zeros(3), euler_rate_matrix(*attitude) @ nu[3:]])
    before, after = (Nmea(start=START).fix(og.State(eta=eta + s * h * step)).heading for s in (-0.5, 0.5))
    assert float(sent(eta, nu)["TIROT"][0]) == pytest.approx(60.0 * (after - before) / h, abs=0.006)
    assert float(sent(nu=[0, 0, 0, 0, 0, 1.0 * deg])["TIROT"][0]) == -60.0  # bow to port


def test_at_rest_there_is_no_course():
    found = sent(nu=[1e-5, 0, 0, 0, 0, 0])
    assert found["GPVTG"][:2] == ["", "T"]
    assert found["GPRMC"][6:8] == ["0.000", ""]


def test_simulated_and_ordinary_fixes():
    found = sent()
    assert (found["GPGGA"][5], found["GPRMC"][1], found["GPRMC"][11], found["GPVTG"][8]) == ("8", "V", "S", "S")
    found = sent(simulated=False)
    assert (found["GPGGA"][5], found["GPRMC"][1], found["GPRMC"][11], found["GPVTG"][8]) == ("1", "A", "A", "A")


def test_numbers_at_the_edge():
    assert sent([0, 0, 0, 0, 0, 90.0001 * deg])["HEHDT"][0] == "0.000"  # not 360.000
    assert sent([0, 0, -1e-9, 0, 1e-9, 0])["PASHR"][4:6] == ["+0.00", "+0.00"]
    far = Nmea(origin=(-89.0 * deg, -179.99 * deg), start=START)
    assert max(map(len, far(og.State(eta=[5e3, 9e4, -12.5, -3.1, -1.5, 99.0], nu=[-25.0] * 6)).splitlines())) <= 80
    assert place(sent(origin=(-0.99999999999 * deg, -0.5 * deg))["GPGGA"][1:5]) == (-1.0, -0.5)  # no sixtieth minute


def test_sentences_can_be_chosen():
    assert list(sent(sentences=["HDT", "ROT"])) == ["HEHDT", "TIROT"]
    assert set(SENTENCES) == {"GGA", "RMC", "VTG", "HDT", "ROT", "XDR", "PASHR"}


def test_time_of_day_in_another_zone():
    from datetime import timedelta, timezone

    zone = timezone(timedelta(hours=2))
    assert sent(start=datetime(2024, 6, 1, 1, 0, tzinfo=zone))["GPRMC"][0] == "230000.000"
    assert sent(start=datetime(2024, 6, 1, 1, 0))["GPRMC"][0] == "010000.000"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"x_axis": "up"}, "x_axis: 'east' or 'north' expected, 'up' found"),
        ({"sentences": ["HDT", "GLL"]}, "sentences"),
        ({"sentences": []}, "sentences"),
        ({"sentences": "HDT"}, "sentences"),
        ({"origin": (90.0 * deg, 0.0)}, "origin: latitude"),
        ({"origin": (59.9, 10.7)}, "in rad expected"),
        ({"origin": (float("nan"), 0.0)}, "origin"),
    ],
)
def test_nmea_refuses(options, words):
    with pytest.raises(og.InputError, match=words):
        Nmea(**options)


# positions


@pytest.mark.parametrize("lat", [-89.9, -45.0, 0.0, 12.3, 59.9, 89.0])
@pytest.mark.parametrize("lon", [-180.0, -70.0, 0.0, 151.2])
def test_earth_centred_and_back(lat, lon):
    found = geographic(*earth_centred(lat * deg, lon * deg))
    assert found[0] == pytest.approx(lat * deg, abs=1e-14)
    assert cos(found[1] - lon * deg) == pytest.approx(1.0, abs=1e-15)


def test_ellipsoid():
    """Points lie on it, its normal is what the latitude says, its axes are those of WGS 84."""
    x, y, z = earth_centred(0.7, 0.3)
    b = SEMI_MAJOR * (1 - FLATTENING)
    assert (x / SEMI_MAJOR) ** 2 + (y / SEMI_MAJOR) ** 2 + (z / b) ** 2 == pytest.approx(1.0, abs=1e-15)
    assert atan2(z / b**2, hypot(x, y) / SEMI_MAJOR**2) == pytest.approx(0.7, abs=1e-15)
    assert earth_centred(pi / 2, 0.0)[2] == pytest.approx(6356752.3142, abs=1e-4)


@pytest.mark.parametrize("lat", [0.0, -35.0, 59.9, 85.0])
def test_small_distances_have_the_radii_of_curvature(lat):
    """North: a (1 - e^2) / W^3, East: a cos(lat) / W."""
    e2 = FLATTENING * (2 - FLATTENING)
    W = (1 - e2 * sin(lat * deg) ** 2) ** 0.5
    at = TangentPlane(lat * deg, 0.5).position(east=1.0, north=1.0)
    assert (at[0] - lat * deg) * SEMI_MAJOR * (1 - e2) / W**3 == pytest.approx(1.0, abs=2e-6)
    assert (at[1] - 0.5) * SEMI_MAJOR * cos(lat * deg) / W == pytest.approx(1.0, abs=4e-6)


def test_the_plane_falls_short_as_stated():
    """d - d^3 / (3 R^2) along the equator."""
    for d in (1e4, 1e5):
        _, lon = TangentPlane(0.0, 0.0).position(east=d, north=0.0)
        assert d - SEMI_MAJOR * lon == pytest.approx(d**3 / (3 * SEMI_MAJOR**2), rel=1e-3)


def test_meridians_converge():
    """Azimuths turn by longitude difference times sin(latitude); at the origin they are those of the plane."""
    plane = TangentPlane(60.0 * deg, 0.0)
    assert plane.azimuth(1.0, 1.0, at=(60.0 * deg, 0.0)) == pytest.approx(45.0 * deg)
    at = plane.position(1e4, 0.0)
    assert plane.azimuth(0.0, 1.0, at=at) == pytest.approx(at[1] * sin(at[0]), rel=2e-3)


@pytest.mark.parametrize("x_axis", ["east", "north"])
def test_the_course_is_where_the_position_goes(x_axis):
    """Two fixes 10 s apart, 20 km from the origin: the great circle between them has the course and speed of the sentences."""
    nmea = Nmea(origin=OSLO, x_axis=x_axis, start=START)
    eta, nu = np.array([15e3, 12e3, 0, 0.05, -0.02, 0.7]), np.array([8.0, 1.0, 0.2, 0, 0, 0])
    v = rotation_matrix(*eta[3:]) @ nu[:3]
    one, two = (nmea.fix(og.State(eta=eta + [*(s * v), 0, 0, 0], nu=nu)) for s in (0.0, 10.0))
    e2 = FLATTENING * (2 - FLATTENING)
    W = (1 - e2 * sin(radians(one.latitude)) ** 2) ** 0.5
    north = radians(two.latitude - one.latitude) * SEMI_MAJOR * (1 - e2) / W**3
    east = radians(two.longitude - one.longitude) * SEMI_MAJOR * cos(radians(one.latitude)) / W
    assert degrees(atan2(east, north)) % 360 == pytest.approx(one.course, abs=2e-3)
    assert hypot(east, north) / 10.0 / knot == pytest.approx(one.speed, rel=1e-4)
    fields = parse_nmea(nmea(og.State(eta=eta, nu=nu)))
    for name, first in (("GPGGA", 1), ("GPRMC", 2)):
        assert place(fields[name][first : first + 4]) == pytest.approx((one.latitude, one.longitude), abs=1e-8)


# the steady frame


@pytest.mark.parametrize("size", [1e-3, 1e-4])
def test_steady_frame_is_kinematics_to_first_order(size):
    """The rate of the pose is R v, T omega but for squares of the motion, with xi' = nu + U (0, psi, -theta, 0, 0, 0)."""
    U, h = 7.0, 1e-5
    frame = SteadyFrame(speed=U, heading=2.0)
    eta, nu = size * np.array([1.0, 2.0, 0.5, 0.2, -0.1, 0.3]), size * np.array([0.3, -0.2, 0.5, 0.04, -0.06, 0.05])
    rates = nu + U * np.array([0.0, eta[5], -eta[4], 0.0, 0.0, 0.0])
    before, now, after = (frame.in_world(og.State(eta + s * h * rates, nu, time=30.0 + s * h)) for s in (-1, 0, 1))
    rate = (after.eta - before.eta) / (2 * h)
    assert rate[:3] == pytest.approx(rotation_matrix(*now.eta[3:]) @ now.nu[:3], abs=5 * size**2 + 1e-9)
    assert rate[3:] == pytest.approx(euler_rate_matrix(*now.eta[3:5]) @ now.nu[3:], abs=5 * size**2 + 1e-9)


def test_a_frame_at_rest_changes_no_pose():
    state = og.State(np.arange(6.0) / 10, np.zeros(6), time=100.0)
    found = SteadyFrame().in_world(state)
    assert np.array_equal(found.eta, state.eta)
    assert not found.nu.any()
    with pytest.raises(og.InputError, match="finite speed and heading"):
        SteadyFrame(speed=float("inf"))


# the sender


@pytest.fixture
def ear():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(20.0)
        yield receiver


def port(ear) -> int:
    return ear.getsockname()[1]


def test_nmea_over_a_socket(ear):
    state = og.State(eta=[1, 2, 0.5, 0.1, 0.05, 0.3], nu=[5, 0, 0, 0, 0, 0.01], time=1.0)
    nmea = Nmea(origin=OSLO, start=START)
    with UdpSender("127.0.0.1", port(ear), format=nmea) as sender:
        sender(state)
    assert ear.recv(4096) == nmea(state)
    with UdpSender("localhost", port(ear), format="nmea") as sender:
        sender(state)
    found = parse_nmea(ear.recv(4096))
    assert place(found["GPGGA"][1:5]) == pytest.approx((2 / 110574.0, 1 / 111320.0), abs=2e-8)


@pytest.mark.parametrize("made", ["heave 0.5 \u00b5", b"\x00\x01"])
def test_a_format_of_ones_own(ear, made):
    with UdpSender("127.0.0.1", port(ear), format=lambda state: made) as sender:
        sender(og.State())
    assert ear.recv(100) == (made.encode() if isinstance(made, str) else made)


@pytest.mark.parametrize(
    ("rate", "dt", "expected"), [(1.0, 0.1, 4), (10.0, 0.1, 31), (4.0, 0.1, 13), (100.0, 0.1, 31), (0.3, 0.1, 1)]
)
def test_rate(ear, rate, dt, expected):
    """Datagrams come evenly over 3 s: at the first state in each 1 / rate."""
    with UdpSender("127.0.0.1", port(ear), rate=rate) as sender:
        for k in range(31):
            sender(og.State(time=k * dt))
    assert sender.sent == expected


def test_what_cannot_be_formatted_is_counted_and_the_rest_goes_on(ear):
    def fussy(state):
        if state.time == 1.0:
            raise ValueError("not this one")
        return f"{state.time}" if state.time != 2.0 else 7

    with UdpSender("127.0.0.1", port(ear), format=fussy) as sender:
        for t in range(4):
            sender(og.State(time=t))
    assert (sender.sent, sender.errors) == (2, 2)
    assert [ear.recv(100) for _ in range(2)] == [b"0.0", b"3.0"]
    assert "2 lost, the last by TypeError" in str(sender)


def test_what_the_system_refuses_is_counted(ear):
    with UdpSender("127.0.0.1", port(ear), format=lambda state: b"x" * 100_000) as sender:
        sender(og.State())
    assert (sender.sent, sender.errors) == (0, 1)
    assert "1 lost" in str(sender)
    sender(og.State())  # after closing
    assert sender.errors == 2


def test_a_full_buffer_does_not_wait(ear, monkeypatch):
    with UdpSender("127.0.0.1", port(ear)) as sender:
        assert sender._socket.getblocking() is False

        class Full:
            def sendto(self, *_):
                raise BlockingIOError(11, "Resource temporarily unavailable")

            def close(self):
                real.close()

        real, sender._socket = sender._socket, Full()
        sender(og.State())
    assert (sender.sent, sender.errors) == (0, 1)
    assert "BlockingIOError" in sender.last_error


def test_json_keeps_every_bit():
    import json

    rng = np.random.default_rng(1)
    state = og.State(rng.normal(size=6) * 1e-7, rng.normal(size=6) * 1e9, time=1 / 3)
    found = json.loads(json_line(state))
    assert found["eta"] == state.eta.tolist()
    assert found["nu"] == state.nu.tolist()
    assert (found["t"], found["version"]) == (1 / 3, 1)


@pytest.mark.parametrize(
    ("where", "options", "words"),
    [
        (("127.0.0.1", 0), {}, "port: a whole number from 1 to 65535 expected, 0 found"),
        (("127.0.0.1", 70000), {}, "port"),
        (("127.0.0.1", "9000"), {}, "port"),
        ((7, 9000), {}, "host"),
        (("a" * 70 + ".invalid", 9000), {}, "host"),
        (("127.0.0.1", 9000), {"format": "xml"}, "format: 'json', 'nmea' or a function of the state expected, 'xml' found"),
        (("127.0.0.1", 9000), {"rate": 0.0}, "rate"),
    ],
)
def test_sender_refuses(where, options, words):
    with pytest.raises(og.InputError, match=words):
        UdpSender(*where, **options)
