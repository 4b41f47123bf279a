"""NovAtel messages by the layout of NovAtel's manual: binary and ASCII, long and short headers, with their CRC."""

import struct
import zlib

import numpy as np

IDS = {
    "INSPVA": 507,
    "INSPVAS": 508,
    "INSPVAX": 1465,
    "INSSTDEV": 2051,
    "INSSTDEVS": 2052,
    "INSCOV": 264,
    "INSCOVS": 320,
}
DEFINITIONS = {"INSPVA": 0x18BC, "INSPVAX": 0x471D, "INSSTDEV": 0x2396, "INSCOV": 0xF78A}  # as receivers send them
GOOD = 3
STATUS_NAMES = {1: "INS_ALIGNING", 3: "INS_SOLUTION_GOOD"}
UNDULATION_M = 24.25


def crc(data):
    """NovAtel's CRC-32: the usual polynomial, but from 0 and not inverted."""
    return zlib.crc32(data, 0xFFFFFFFF) ^ 0xFFFFFFFF


def binary(name, week, second, payload):
    if name.endswith("S"):
        head = struct.pack("<3sBHHI", b"\xaaD\x13", len(payload), IDS[name], week, round(second * 1000))
    else:
        first = (b"\xaaD\x12", 28, IDS[name], 0, 32, len(payload), 0, 100, 180)
        last = (week, round(second * 1000), 0, DEFINITIONS[name], 0)
        head = struct.pack("<3sBHBBHHBBHIIHH", *first, *last)
    return head + payload + struct.pack("<I", crc(head + payload))


def ascii_(name, week, second, fields):
    if name.endswith("S"):
        sync, text = "%", f"{name}A,{week},{second:.3f};{','.join(fields)}"
    else:
        head = f"{name}A,COM1,0,90.0,FINESTEERING,{week},{second:.3f},00000000,{DEFINITIONS.get(name, 0):04x},16248"
        sync, text = "#", f"{head};{','.join(fields)}"
    return f"{sync}{text}*{crc(text.encode()):08x}\r\n".encode()


def pva(name, drive, row, binary_form, status=GOOD):
    """An INSPVA or INSPVAS message."""
    week, second = int(drive.week[row]), float(drive.second[row])
    place, angles = drive.geodetic[row], np.rad2deg(drive.true_euler[row])
    angles[2] %= 360
    if binary_form:
        payload = struct.pack("<Id9dI", week, second, *place, 0.1, 0.2, 0.3, *angles, status)
        return binary(name, week, second, payload)
    numbers = [f"{place[0]:.11f}", f"{place[1]:.11f}", f"{place[2]:.4f}", "0.1000", "0.2000", "0.3000"]
    fields = [f"{week}", f"{second:.9f}", *numbers, *(f"{one:.9f}" for one in angles), STATUS_NAMES[status]]
    return ascii_(name, week, second, fields)


def pvax(drive, row, binary_form):
    """An INSPVAX message: the height is above the geoid."""
    week, second = int(drive.week[row]), float(drive.second[row])
    latitude, longitude, height = drive.geodetic[row]
    angles = np.rad2deg(drive.true_euler[row]) % 360
    sigma = np.sqrt(np.diag(drive.covariance[row])) * [1, 1, 1, *[180 / np.pi] * 3]
    if binary_form:
        place = struct.pack("<IIdddf", GOOD, 56, latitude, longitude, height - UNDULATION_M, UNDULATION_M)
        motion = struct.pack("<6d", 0.1, 0.2, 0.3, *angles)
        accuracy = struct.pack("<9fIH", *sigma[:3], 0.1, 0.1, 0.1, *sigma[3:], 0, 0)
        return binary("INSPVAX", week, second, place + motion + accuracy)
    fields = [
        "INS_SOLUTION_GOOD", "INS_RTKFIXED", f"{latitude:.11f}", f"{longitude:.11f}", f"{height - UNDULATION_M:.4f}",
        f"{UNDULATION_M:.4f}", "0.1000", "0.2000", "0.3000", *(f"{one:.9f}" for one in angles),
        *(f"{one:.4f}" for one in (*sigma[:3], 0.1, 0.1, 0.1, *sigma[3:])), "00000000", "0",
    ]  # fmt: skip
    return ascii_("INSPVAX", week, second, fields)


def stdev(drive, row, binary_form):
    """An INSSTDEV message."""
    week, second = int(drive.week[row]), float(drive.second[row])
    sigma = np.sqrt(np.diag(drive.covariance[row])) * [1, 1, 1, *[180 / np.pi] * 3]
    values = (*sigma[:3], 0.1, 0.1, 0.1, *sigma[3:])
    if binary_form:
        return binary("INSSTDEV", week, second, struct.pack("<9fIHHII", *values, 0, 0, 0, 0, 0))
    fields = [*(f"{one:.4f}" for one in values), "00000000", "0", "0", "00000000", "0"]
    return ascii_("INSSTDEV", week, second, fields)


def cov(name, drive, row, position, turns_deg2, binary_form):
    """An INSCOV or INSCOVS message: covariances of position, of turns about east, north, up (deg^2), of velocity."""
    week, second = int(drive.week[row]), float(drive.second[row])
    values = [*position.ravel(), *turns_deg2.ravel(), *(0.01 * np.eye(3)).ravel()]
    if binary_form:
        return binary(name, week, second, struct.pack("<Id27d", week, second, *values))
    return ascii_(name, week, second, [f"{week}", f"{second:.9f}", *(f"{one:.12e}" for one in values)])
