#!/usr/bin/env python3
"""Draws docs/architecture.svg: the rooms, and the way of a map to a pixel. `--check` fails where the picture is stale or a room of
tests/arrows.py is missing."""
import os
import re
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
PICTURE = os.path.join(FOLDER, "architecture.svg")
WIDTH, HEIGHT = 1180, 840
BOX = 150, 46

# Groups of rooms: name, colour, rectangle.
GROUPS = [
    ("artist's machine: bake", "#e8f0fb", (20, 40, 190, 400)),
    ("daemon: bakerd serve", "#eef7ea", (240, 40, 380, 400)),
    ("worker process: bakerd worker", "#fdf3e3", (650, 40, 510, 400)),
    ("a game, and drtv", "#f4ecf8", (20, 480, 760, 330)),
    ("bakerd render", "#eeeeee", (810, 480, 350, 330)),
]

# Room or thing -> middle of its box, and a second line. Things are not rooms: they are drawn with round ends.
ROOMS = {
    "client": (115, 210, "bake"),
    "map_files": (115, 152, "which files"),
    "settings": (115, 300, "one table"),
    "settings/message": (115, 375, "as messages"),
    "proto": (330, 110, "the contract"),
    "bakerd/service": (330, 210, "gRPC"),
    "bakerd/farm": (530, 210, "jobs, plans, cache"),
    "bakerd/store": (420, 310, "blobs by digest"),
    "bakerd/executor": (530, 110, "where it is baked"),
    "bakerd/worker": (740, 210, "asks and answers"),
    "bakerd/map": (740, 310, "glTF to objects"),
    "bakerd/trace": (905, 310, "rays, Embree"),
    "bakerd/reuse": (905, 120, "what an edit changes"),
    "bakerd/bake": (1075, 210, "one sector"),
    "placement": (1075, 310, "probes, grid"),
    "format": (110, 570, "read, write, validate"),
    "format/runtime": (300, 570, "relight, volumes"),
    "format/light": (490, 570, "a day as JSON"),
    "format/cli": (490, 660, "exit codes, messages"),
    "format/spelling": (490, 750, "did you mean"),
    "format/folder": (680, 750, "manifest, whole files"),
    "format/image": (300, 750, "PNG, map sheets"),
    "format/kit": (680, 570, "folders, light"),
    "format/tool": (680, 660, "drtv"),
    "bakerd/picture": (985, 570, "relit and path-traced"),
}
THINGS = {
    "map.glb": (115, 92, "and its pictures"),
    "database": (540, 385, "SQLite"),
    "sector files": (335, 385, "16-bit, versioned"),
    "pixels of a game": (300, 660, "three textures"),
    "picture.png": (985, 660, ""),
}

# From, to, label.
FLOWS = [
    ("map.glb", "map_files", ""),
    ("map_files", "client", ""),
    ("client", "bakerd/service", "files, a job"),
    ("bakerd/service", "bakerd/farm", "request"),
    ("bakerd/farm", "bakerd/executor", "sectors"),
    ("bakerd/executor", "bakerd/worker", ""),
    ("bakerd/farm", "bakerd/store", ""),
    ("bakerd/worker", "bakerd/map", "blobs"),
    ("bakerd/map", "bakerd/trace", ""),
    ("bakerd/worker", "bakerd/reuse", "earlier result"),
    ("bakerd/reuse", "bakerd/bake", "what still holds"),
    ("bakerd/bake", "placement", ""),
    ("bakerd/trace", "bakerd/bake", "hits"),
    ("bakerd/store", "sector files", "pull"),
    ("bakerd/farm", "database", ""),
    ("bakerd/worker", "bakerd/store", "results"),
    ("sector files", "format", ""),
    ("format", "format/runtime", "views"),
    ("format/runtime", "pixels of a game", ""),
    ("format/light", "format/runtime", ""),
    ("format/kit", "format/tool", ""),
    ("format/folder", "format/tool", ""),
    ("format/kit", "bakerd/picture", "relit sectors"),
    ("bakerd/picture", "picture.png", ""),
]


def border(middle, towards):
    """Where the line between two middles leaves the box."""
    (x, y), (to_x, to_y) = middle, towards
    dx, dy = to_x - x, to_y - y
    share = min(BOX[0] / 2 / abs(dx) if dx else 9, BOX[1] / 2 / abs(dy) if dy else 9)
    return x + dx * share, y + dy * share


def box(name, x, y, second, rounded):
    width, height = BOX
    radius = height / 2 if rounded else 4
    fill = "#fffbe6" if rounded else "#ffffff"
    first_y = y - 3 if second else y + 5
    text = (
        f'<rect x="{x - width / 2:g}" y="{y - height / 2:g}" width="{width}" height="{height}" rx="{radius:g}" '
        f'fill="{fill}" stroke="#555555"/>\n'
        f'<text x="{x}" y="{first_y}" font-weight="bold">{name}</text>\n'
    )
    return text + (f'<text x="{x}" y="{y + 14}" font-size="11">{second}</text>\n' if second else "")


def drawn():
    places = {name: (x, y) for name, (x, y, _) in {**ROOMS, **THINGS}.items()}
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
        f'font-size="13" text-anchor="middle">\n<defs><marker id="tip" markerWidth="9" markerHeight="9" refX="8" '
        f'refY="4" orient="auto"><path d="M0,0 L9,4 L0,8 z" fill="#333333"/></marker></defs>\n'
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>\n'
    ]
    for name, colour, (x, y, width, height) in GROUPS:
        out.append(f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="8" fill="{colour}"/>\n')
        out.append(f'<text x="{x + 12}" y="{y + 20}" text-anchor="start" fill="#555555">{name}</text>\n')
    for start, end, label in FLOWS:
        x0, y0 = border(places[start], places[end])
        x1, y1 = border(places[end], places[start])
        out.append(
            f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}" stroke="#333333" marker-end="url(#tip)"/>\n'
        )
        if label:
            side = 8 if abs(x1 - x0) < abs(y1 - y0) else 0
            anchor = ' text-anchor="start"' if side else ""
            out.append(
                f'<text x="{(x0 + x1) / 2 + side:.1f}" y="{(y0 + y1) / 2 - 6:.1f}" font-size="11" fill="#333333"{anchor}>'
                f"{label}</text>\n"
            )
    out += [box(name, x, y, second, False) for name, (x, y, second) in ROOMS.items()]
    out += [box(name, x, y, second, True) for name, (x, y, second) in THINGS.items()]
    return "".join(out) + "</svg>\n"


def main():
    if "--check" not in sys.argv:
        with open(PICTURE, "w", encoding="utf-8") as file:
            file.write(drawn())
        return
    with open(PICTURE, encoding="utf-8") as file:
        errors = (
            []
            if file.read() == drawn()
            else ["docs/architecture.svg is stale: run docs/draw_architecture.py"]
        )
    with open(os.path.join(FOLDER, "..", "tests", "arrows.py"), encoding="utf-8") as file:
        rooms = set(
            re.findall(r'^    "([\w/]+)": "', file.read().split("ROOMS = {")[1].split("}")[0], re.MULTILINE)
        )
    errors += [
        f"docs/draw_architecture.py draws no room {room}" for room in sorted(rooms - set(ROOMS) - {"bakerd"})
    ]
    errors += [
        f"docs/draw_architecture.py draws {room}, which is no room" for room in sorted(set(ROOMS) - rooms)
    ]
    print("\n".join(errors))
    sys.exit(1 if errors else 0)


main()
