"""A reader of sector files after format/SPEC.md that uses nothing of our code, so that the page itself is tried."""
import struct


def xxh64(data):
    """XXH64, seed 0 (Cyan4973/xxHash, doc/xxhash_spec.md)."""
    mask = (1 << 64) - 1
    p1, p2, p3, p4, p5 = (0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5)

    def rotl(value, count):
        return ((value << count) | (value >> (64 - count))) & mask

    def step(lane, word):
        return rotl((lane + word * p2) & mask, 31) * p1 & mask

    at, total = 0, p5
    if len(data) >= 32:
        lanes = [(p1 + p2) & mask, p2, 0, -p1 & mask]
        while at + 32 <= len(data):
            lanes = [step(lane, word) for lane, word in zip(lanes, struct.unpack_from("<4Q", data, at))]
            at += 32
        total = sum(rotl(lane, count) for lane, count in zip(lanes, (1, 7, 12, 18))) & mask
        for lane in lanes:
            total = ((total ^ step(0, lane)) * p1 + p4) & mask
    total = (total + len(data)) & mask
    while at + 8 <= len(data):
        total = (rotl(total ^ step(0, struct.unpack_from("<Q", data, at)[0]), 27) * p1 + p4) & mask
        at += 8
    if at + 4 <= len(data):
        total = (rotl(total ^ (struct.unpack_from("<I", data, at)[0] * p1 & mask), 23) * p2 + p3) & mask
        at += 4
    for byte in data[at:]:
        total = rotl(total ^ (byte * p5 & mask), 11) * p1 & mask
    total = (total ^ (total >> 33)) * p2 & mask
    total = (total ^ (total >> 29)) * p3 & mask
    return total ^ (total >> 32)


def as_float32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def decode_fixed(code, scale):
    return as_float32(code / 32767) * scale


def read(data):
    """The sector as `drtv dump --json` shows it. Codec raw only; AssertionError where the page's rules are broken."""
    magic, major, minor, size, count, i, j, z_origin, probes, z_shift = struct.unpack_from("<4sHHIIiiiHB", data, 0)
    assert (magic, major, size) == (b"DRTV", 1, len(data)) and probes <= 255 and z_shift <= 10 and not any(data[31:56])
    table = data[64:64 + 32 * count]
    assert struct.unpack_from("<Q", data, 56)[0] == xxh64(data[:56] + table)
    sections, end = {}, 64 + 32 * count
    for n in range(count):
        kind, version, codec, r0, r1, r2, offset, stored, raw, r3, checksum = struct.unpack_from("<HHBBBBIIIIQ", table, 32 * n)
        assert (version, codec, r0, r1, r2, r3, raw) == (1, 0, 0, 0, 0, 0, stored)
        assert offset == (end + 15) // 16 * 16 and not any(data[end:offset]) and kind not in sections
        sections[kind] = data[offset:offset + stored]
        assert xxh64(sections[kind]) == checksum
        end = offset + stored
    assert end == len(data)
    assert [len(sections[kind]) for kind in range(1, 7)] == [48, 8 * probes, 8 * probes, 96 * probes, 4112, 40]

    rays, bounces, reach, distance = struct.unpack_from("<IIff", sections[1])
    sector = {"format_version": f"{major}.{minor}", "sector": [i, j],
              "settings": {"rays": rays, "bounces": bounces, "reach": reach, "min_distance": distance, "key": sections[1][16:].hex()},
              "probes": []}
    for p in range(probes):
        x, y, z, kind, reserved = struct.unpack_from("<HHHBB", sections[2], 8 * p)
        assert reserved == 0
        units = (65536 * i + x, 65536 * j + y, z_origin + z * 2**z_shift)
        transfer = [[[decode_fixed(struct.unpack_from("<h", sections[4], 96 * p + 32 * c + 8 * b + 2 * k)[0], 0.5) for k in range(4)]
                     for b in range(4)] for c in range(3)]
        sector["probes"].append({
            "position": [u / 1024 for u in units], "kind": ("ground", "vegetation", "manual")[kind], "transfer": transfer,
            "sky_visibility": [decode_fixed(code, 1) for code in struct.unpack_from("<4h", sections[3], 8 * p)]})
    grid_z, cell_height, reserved = struct.unpack_from("<iIQ", sections[5])
    assert reserved == 0
    sector["grid"] = {"origin": [64 * i, 64 * j, grid_z / 1024], "cell": [4, 4, cell_height / 1024], "size": [16, 16, 16],
                      "cells": list(sections[5][16:])}
    names = ("candidates", "moved_out", "dropped_in_solid", "removed_by_volume", "thinned", "used_distance", "rays", "back_hits")
    sector["statistics"] = dict(zip(names, struct.unpack("<IIIIIfQQ", sections[6])))
    return sector
