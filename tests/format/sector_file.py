"""A reader of sector files after format/SPEC.md that uses nothing of our code, so that the page itself is tried."""
import math
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


def read_codes(section, offset, exponent):
    """Three channels of four codes."""
    codes = struct.unpack_from("<12h", section, offset)
    return [[decode_fixed(code, 2.0**exponent) for code in codes[4 * c:4 * c + 4]] for c in range(3)]


def read_static_irradiance(section, probes):
    assert len(section) == 25 * probes
    exponents = struct.unpack_from(f"<{probes}b", section, 24 * probes)
    return [read_codes(section, 24 * p, exponents[p]) for p in range(probes)]


def read_local_transfer(section, i, j, probes):
    """For each probe, its pairs in the order of their sources."""
    source_count, mask_bytes, pair_count, reserved = struct.unpack_from("<HHIQ", section)
    assert source_count <= 255 and mask_bytes == (16 if source_count <= 128 else 32) and reserved == 0
    receivers_at = (16 + 4 * source_count + 15) // 16 * 16
    masks_at = (receivers_at + 8 * probes + 15) // 16 * 16
    codes_at = masks_at + mask_bytes * probes
    assert len(section) == codes_at + 24 * pair_count
    assert not any(section[16 + 4 * source_count:receivers_at]) and not any(section[receivers_at + 8 * probes:masks_at])
    sources = [struct.unpack_from("<bbBb", section, 16 + 4 * s) for s in range(source_count)]
    assert all(abs(di) <= 1 and abs(dj) <= 1 and probe < (255 if di or dj else probes) for di, dj, probe, _ in sources)
    pair, local = 0, []
    for p in range(probes):
        first_pair, exponent, r0, r1, r2 = struct.unpack_from("<Ib3B", section, receivers_at + 8 * p)
        assert (first_pair, r0, r1, r2) == (pair, 0, 0, 0)
        mask = int.from_bytes(section[masks_at + mask_bytes * p:masks_at + mask_bytes * (p + 1)], "little")
        assert mask >> source_count == 0
        local.append([])
        for s, (di, dj, probe, source_exponent) in enumerate(sources):
            if mask >> s & 1:
                local[p].append({"sector": [i + di, j + dj], "probe": probe,
                                 "coefficients": read_codes(section, codes_at + 24 * pair, exponent + source_exponent)})
                pair += 1
    assert pair == pair_count
    return local


def read(data):
    """The sector as `drtv dump --json` shows it. Codec raw only; AssertionError where the page's rules are broken."""
    magic, major, minor, size, count, i, j, z_origin, probes, z_shift = struct.unpack_from("<4sHHIIiiiHB", data, 0)
    light = minor >= 1  # before, the kinds 7 to 9 were unused
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
    static_irradiance = read_static_irradiance(sections[7], probes) if light and 7 in sections else None
    local = read_local_transfer(sections[8], i, j, probes) if light and 8 in sections else None

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
        if static_irradiance is not None:
            sector["probes"][-1]["static_irradiance"] = static_irradiance[p]
        if local is not None:
            sector["probes"][-1]["local"] = local[p]
    grid_z, cell_height, reserved = struct.unpack_from("<iIQ", sections[5])
    assert reserved == 0
    sector["grid"] = {"origin": [64 * i, 64 * j, grid_z / 1024], "cell": [4, 4, cell_height / 1024], "size": [16, 16, 16],
                      "cells": list(sections[5][16:])}
    names = ("candidates", "moved_out", "dropped_in_solid", "removed_by_volume", "thinned", "used_distance", "rays", "back_hits")
    sector["statistics"] = dict(zip(names, struct.unpack("<IIIIIfQQ", sections[6])))
    if light and 9 in sections:
        names = ("error_asked", "error_median", "error_p95", "error_max", "paths_least", "paths_most", "local_bounces", "local_rays",
                 "static_rays", "local_transfer_rays")
        sector["convergence"] = dict(zip(names, struct.unpack("<4f4I2Q", sections[9])))
        assert all(math.isfinite(sector["convergence"][name]) for name in names)
    return sector
