"""A reader of sector files after format/SPEC.md that uses nothing of our code, so that the page itself is tried."""
import math
import struct

import zstd_frame

SINCE_MINOR = {
    (7, 1): 1,
    (8, 1): 1,
    (9, 1): 1,
    (10, 1): 2,
    (8, 2): 2,
    (8, 3): 3,
    (11, 1): 3,
    (12, 1): 3,
}  # of (kind, version), for the sections that may be missing
RAW, ZSTD, FILTERED = 0, 1, 2
CODECS = {(8, 2): (FILTERED,), (8, 3): (RAW, FILTERED)}  # of (kind, version); of all others RAW and ZSTD
MOST_SOURCES = {1: 255, 2: 255, 3: 2295}  # of each version of local transfer


def xxh64(data):
    """XXH64, seed 0 (Cyan4973/xxHash, doc/xxhash_spec.md)."""
    mask = (1 << 64) - 1
    p1, p2, p3, p4, p5 = (
        0x9E3779B185EBCA87,
        0xC2B2AE3D27D4EB4F,
        0x165667B19E3779F9,
        0x85EBCA77C2B2AE63,
        0x27D4EB2F165667C5,
    )

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


def next_16(offset):
    """The next multiple of 16 at or after it."""
    return (offset + 15) // 16 * 16


def as_int16(value):
    """Modulo 2^16."""
    return (value + 32768) % 65536 - 32768


def read_codes(section, offset, exponent):
    """Three channels of four codes. The exponent is clamped as section 5.8 asks of a reader that does not reject it."""
    codes = struct.unpack_from("<12h", section, offset)
    return [
        [decode_fixed(code, 2.0 ** max(-126, min(126, exponent))) for code in codes[4 * c : 4 * c + 4]]
        for c in range(3)
    ]


def read_bake(section):
    rays, bounces, reach, distance = struct.unpack_from("<IIff", section)
    assert math.isfinite(reach) and math.isfinite(distance)
    return {
        "rays": rays,
        "bounces": bounces,
        "reach": reach,
        "min_distance": distance,
        "key": section[16:].hex(),
    }


def read_probes(positions, visibilities, transfers, i, j, z_origin, z_shift):
    """The sections 2 to 4."""
    probes = []
    for p in range(len(positions) // 8):
        x, y, z, kind, reserved = struct.unpack_from("<HHHBB", positions, 8 * p)
        assert kind <= 2 and reserved == 0
        units = (65536 * i + x, 65536 * j + y, z_origin + z * 2**z_shift)
        probes.append(
            {
                "position": [u / 1024 for u in units],
                "kind": ("ground", "vegetation", "manual")[kind],
                "transfer": [
                    [
                        [
                            decode_fixed(code, 0.5)
                            for code in struct.unpack_from("<4h", transfers, 96 * p + 32 * c + 8 * b)
                        ]
                        for b in range(4)
                    ]
                    for c in range(3)
                ],
                "sky_visibility": [
                    decode_fixed(code, 1) for code in struct.unpack_from("<4h", visibilities, 8 * p)
                ],
            }
        )
    return probes


def read_grid(section, i, j):
    z_origin, cell_height, reserved = struct.unpack_from("<iIQ", section)
    assert abs(z_origin) <= 2**30 and 1 <= cell_height <= 2**24 and reserved == 0
    return {
        "origin": [64 * i, 64 * j, z_origin / 1024],
        "cell": [4, 4, cell_height / 1024],
        "size": [16, 16, 16],
        "cells": list(section[16:]),
    }


def read_statistics(section):
    names = (
        "candidates",
        "moved_out",
        "dropped_in_solid",
        "removed_by_volume",
        "thinned",
        "used_distance",
        "rays",
        "back_hits",
    )
    statistics = dict(zip(names, struct.unpack("<IIIIIfQQ", section)))
    assert math.isfinite(statistics["used_distance"])
    return statistics


def read_static_irradiance(section, probes):
    assert len(section) == 25 * probes
    exponents = struct.unpack_from(f"<{probes}b", section, 24 * probes)
    return [read_codes(section, 24 * p, exponents[p]) for p in range(probes)]


def local_transfer_layout(section, probes):
    """The source count, the mask bytes and the pair count, and where the receivers, the masks and the codes begin. The most
    sources depend on the version: decode_section looks at them."""
    source_count, mask_bytes, pair_count, reserved = struct.unpack_from("<HHIQ", section)
    assert mask_bytes == 16 * max(1, (source_count + 127) // 128) and reserved == 0
    receivers_at = next_16(16 + 4 * source_count)
    masks_at = next_16(receivers_at + 8 * probes)
    return source_count, mask_bytes, pair_count, receivers_at, masks_at, masks_at + mask_bytes * probes


def read_local_transfer(section, i, j, probes):
    """For each probe, its pairs in the order of their sources."""
    source_count, mask_bytes, pair_count, receivers_at, masks_at, codes_at = local_transfer_layout(
        section, probes
    )
    assert len(section) == codes_at + 24 * pair_count
    assert not any(section[16 + 4 * source_count : receivers_at]) and not any(
        section[receivers_at + 8 * probes : masks_at]
    )
    sources = [struct.unpack_from("<bbBb", section, 16 + 4 * s) for s in range(source_count)]
    assert all(
        abs(di) <= 1 and abs(dj) <= 1 and probe < (255 if di or dj else probes)
        for di, dj, probe, _ in sources
    )
    pair, local = 0, []
    for p in range(probes):
        first_pair, exponent, r0, r1, r2 = struct.unpack_from("<Ib3B", section, receivers_at + 8 * p)
        assert (first_pair, r0, r1, r2) == (pair, 0, 0, 0)
        mask = int.from_bytes(section[masks_at + mask_bytes * p : masks_at + mask_bytes * (p + 1)], "little")
        assert mask >> source_count == 0 and pair + mask.bit_count() <= pair_count
        local.append([])
        for s, (di, dj, probe, source_exponent) in enumerate(sources):
            if mask >> s & 1:
                local[p].append(
                    {
                        "sector": [i + di, j + dj],
                        "probe": probe,
                        "coefficients": read_codes(section, codes_at + 24 * pair, exponent + source_exponent),
                    }
                )
                pair += 1
    assert pair == pair_count
    return local


def read_convergence(section):
    names = (
        "error_asked",
        "error_median",
        "error_p95",
        "error_max",
        "paths_least",
        "paths_most",
        "local_bounces",
        "local_rays",
        "static_rays",
        "local_transfer_rays",
    )
    convergence = dict(zip(names, struct.unpack("<4f4I2Q", section)))
    assert all(math.isfinite(convergence[name]) for name in names)
    return convergence


def read_interiors(section, probes):
    """For each interior its probe and its mesh, in metres of the world."""
    interior_count, r0, vertex_count, triangle_count, r1 = struct.unpack_from("<HHIII", section)
    assert (
        interior_count <= 1024
        and vertex_count <= 65536 * interior_count
        and triangle_count <= 2**18
        and (r0, r1) == (0, 0)
    )
    vertices_at = 16 + 32 * interior_count
    triangles_at = next_16(vertices_at + 6 * vertex_count)
    assert len(section) == triangles_at + 6 * triangle_count and not any(
        section[vertices_at + 6 * vertex_count : triangles_at]
    )
    interiors, vertex, triangle = [], 0, 0  # and how many stand before this interior
    for n in range(interior_count):
        fields = struct.unpack_from("<3iBBH4I", section, 16 + 32 * n)
        *origin, shift, probe, r0, first_vertex, vertices, first_triangle, triangles = fields
        assert all(abs(o) <= 2**30 + 2**27 for o in origin) and shift <= 10 and probe < probes and r0 == 0
        assert (first_vertex, first_triangle) == (vertex, triangle) and vertices <= 65536
        assert vertex + vertices <= vertex_count and triangle + triangles <= triangle_count
        steps = struct.iter_unpack(
            "<3H", section[vertices_at + 6 * vertex : vertices_at + 6 * (vertex + vertices)]
        )
        corners = struct.iter_unpack(
            "<3H", section[triangles_at + 6 * triangle : triangles_at + 6 * (triangle + triangles)]
        )
        interiors.append(
            {
                "probe": probe,
                "vertices": [[(o + s * 2**shift) / 1024 for o, s in zip(origin, step)] for step in steps],
                "triangles": [list(indices) for indices in corners],
            }
        )
        assert all(index < vertices for indices in interiors[n]["triangles"] for index in indices)
        vertex, triangle = vertex + vertices, triangle + triangles
    assert (vertex, triangle) == (vertex_count, triangle_count)
    return interiors


def read_light_groups(section, probes):
    """The names of the groups, and for each probe its static irradiance of each group."""
    group_count, *reserved = struct.unpack_from("<H14B", section)
    assert 1 <= group_count <= 8 and not any(reserved)
    codes_at = 16 + 64 * group_count
    assert len(section) == codes_at + 25 * probes * group_count
    names = [section[at : at + 64].rstrip(b"\0") for at in range(16, codes_at, 64)]
    assert all(1 <= len(name) <= 63 and 0 not in name for name in names)
    names = [name.decode("utf-8", "replace") for name in names]
    irradiances = read_static_irradiance(section[codes_at:], probes * group_count)  # group by group
    return names, [irradiances[p::probes] for p in range(probes)]


def read_quality(section, probes):
    """That of the sector, and that of each probe."""
    buried_cells, blind_cells, group_count, *reserved = struct.unpack_from("<IIH6B", section)
    assert group_count <= 8 and not any(reserved)
    group_errors_at = 16 + 24 * probes
    assert len(section) == group_errors_at + 4 * probes * group_count
    names = ("transfer_error", "visibility_error", "static_error", "paths", "back_hits")
    flag_names = ("budget_ended", "dark", "moved")
    qualities = []
    for p in range(probes):
        *numbers, flags, r0, r1, r2 = struct.unpack_from("<3f2I4B", section, 16 + 24 * p)
        assert all(math.isfinite(number) for number in numbers)
        assert flags < 8 and (r0, r1, r2) == (0, 0, 0)
        qualities.append(
            dict(zip(names, numbers)) | {name: bool(flags >> bit & 1) for bit, name in enumerate(flag_names)}
        )
    group_errors = struct.unpack_from(f"<{probes * group_count}f", section, group_errors_at)  # group by group
    assert all(math.isfinite(error) for error in group_errors)
    for p in range(probes):
        qualities[p]["group_errors"] = list(group_errors[p::probes])
    return {"buried_cells": buried_cells, "blind_cells": blind_cells}, qualities


def read_residuals(high, low, classes):
    """For each pair its 12 residuals, out of their groups (section 5.10, Order)."""
    weights = (1, -1, -1, -1, -2, -4, -4, -4, -2, -4, -4, -4)
    residuals = [[0] * 12 for _ in classes]
    order = sorted(
        (classes[n] + weights[k], classes[n], k, n) for n in range(len(classes)) for k in range(12)
    )
    for (_, _, k, n), high_byte, low_byte in zip(order, high, low, strict=True):
        zigzag = high_byte << 8 | low_byte
        residuals[n][k] = -(zigzag + 1) // 2 if zigzag & 1 else zigzag // 2
    return residuals


def foretell_first(green, sum_c, sum_g):
    """v_c[0] of red or blue, from that of green and the sums of both (section 5.10, Decoding). Nothing here is negative."""
    return (max(green, 0) * sum_c + sum_g // 2) // sum_g


def foretell(green, green_first, first):
    """v_c[i] of red or blue for i > 0, from v_g[i], v_g[0] and v_c[0]. Rounds to the nearest, ties away from zero."""
    product, divisor = green * first, max(green_first, 1)
    size = (abs(product) + divisor // 2) // divisor
    return size if product >= 0 else -size


def unfilter(filtered, probes):
    """The raw bytes of a filtered local transfer."""
    *_, pair_count, _, _, head = local_transfer_layout(filtered, probes)
    assert len(filtered) == head + 26 * pair_count
    shifts, classes, high, low = (
        filtered[head + first * pair_count : head + end * pair_count]
        for first, end in ((0, 1), (1, 2), (2, 14), (14, 26))
    )
    assert all(shift <= 15 for shift in shifts) and all(bits <= 16 for bits in classes)
    sums, codes = [1, 1, 1], []  # r, g, b
    for shift, residual in zip(shifts, read_residuals(high, low, classes)):
        values = [[], [as_int16(r) for r in residual[:4]], []]  # r, g, b
        green = values[1]
        for c, first_residual in ((0, 4), (2, 8)):
            for i, r in enumerate(residual[first_residual : first_residual + 4]):
                foretold = (
                    foretell(green[i], green[0], values[c][0])
                    if i
                    else foretell_first(green[0], sums[c], sums[1])
                )
                values[c].append(as_int16(foretold + r))
        sums = [max(1, s - s // 4 + max(v[0], 0)) for s, v in zip(sums, values)]
        codes += [as_int16(value << shift) for channel in values for value in channel]
    return filtered[:head] + struct.pack(f"<{len(codes)}h", *codes)


def decode_section(kind, version, codec, stored, raw_bytes, probes):
    """The raw bytes of a section that is not ignored."""
    assert codec in CODECS.get((kind, version), (RAW, ZSTD))
    section = stored if codec == RAW else zstd_frame.decode(stored)
    assert kind != 8 or struct.unpack_from("<H", section)[0] <= MOST_SOURCES[version]
    if codec == FILTERED:
        section = unfilter(section, probes)
    assert len(section) == raw_bytes
    return section


def read_sections(data, table, minor, probes):
    """Of each kind that is not ignored, the raw bytes."""
    entries, end = {}, 64 + len(table)
    for kind, version, codec, r0, r1, r2, offset, stored_bytes, raw_bytes, r3, checksum in struct.iter_unpack(
        "<HHB3BIIIIQ", table
    ):
        assert (
            (r0, r1, r2, r3) == (0, 0, 0, 0)
            and raw_bytes <= 2**24
            and (codec != RAW or raw_bytes == stored_bytes)
        )
        assert offset == next_16(end) and not any(data[end:offset]) and kind not in entries
        end = offset + stored_bytes
        assert end <= len(data) and xxh64(data[offset:end]) == checksum
        entries[kind] = (version, codec, data[offset:end], raw_bytes)
    assert end == len(data)
    assert all(entries[kind][0] == 1 for kind in range(1, 7))  # KeyError where one is missing
    return {
        kind: decode_section(kind, *entry, probes)
        for kind, entry in entries.items()
        if 1 <= kind <= 6 or minor >= SINCE_MINOR.get((kind, entry[0]), math.inf)
    }


def read(data):
    """The sector as `drtv dump --json` shows it. Where the page's rules are broken: AssertionError, KeyError or struct.error, and
    ValueError where a Zstandard frame is."""
    magic, major, minor, size, count, i, j, z_origin, probes, z_shift = struct.unpack_from(
        "<4sHHIIiiiHB", data, 0
    )
    assert (magic, major, size) == (b"DRTV", 1, len(data)) and count <= 64 and 64 + 32 * count <= size
    table = data[64 : 64 + 32 * count]
    assert struct.unpack_from("<Q", data, 56)[0] == xxh64(data[:56] + table)
    assert (
        abs(i) <= 16384
        and abs(j) <= 16384
        and abs(z_origin) <= 2**30
        and probes <= 255
        and z_shift <= 10
        and not any(data[31:56])
    )
    sections = read_sections(data, table, minor, probes)
    assert [len(sections[kind]) for kind in range(1, 7)] == [
        48,
        8 * probes,
        8 * probes,
        96 * probes,
        4112,
        40,
    ]

    sector = {
        "format_version": f"{major}.{minor}",
        "sector": [i, j],
        "settings": read_bake(sections[1]),
        "probes": read_probes(sections[2], sections[3], sections[4], i, j, z_origin, z_shift),
        "grid": read_grid(sections[5], i, j),
        "statistics": read_statistics(sections[6]),
    }
    per_probe = {}
    if 7 in sections:
        per_probe["static_irradiance"] = read_static_irradiance(sections[7], probes)
    if 8 in sections:
        per_probe["local"] = read_local_transfer(sections[8], i, j, probes)
    if 9 in sections:
        sector["convergence"] = read_convergence(sections[9])
    if 10 in sections:
        sector["interiors"] = read_interiors(sections[10], probes)
    if 11 in sections:
        sector["light_groups"], per_probe["light_groups"] = read_light_groups(sections[11], probes)
    if 12 in sections:
        sector["quality"], per_probe["quality"] = read_quality(sections[12], probes)
    for name, values in per_probe.items():
        for probe, value in zip(sector["probes"], values, strict=True):
            probe[name] = value
    return sector
