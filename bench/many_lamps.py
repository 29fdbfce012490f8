#!/usr/bin/env python3
"""Lightwell with ten to many thousand lamps: time, memory and error in one table.

  python3 bench/many_lamps.py LIGHTWELL FOLDER KIND COUNT... [-- OPTION...]

A hall of 60 x 40 x 10 m with 60 machines, lit by COUNT lamps of KIND in a grid: `point` (even in all directions), `spot` (a cone of 45 degrees
at most) or `panel` (luminous squares). All lamps together give 600 klm, so that halls of all counts look alike. `OPTION...` go to `lightwell
solve`. FOLDER gets scenes, solutions and reports.

`error` is the solution's own estimate. `probe` compares the light of 100 points, straight from point lamps in the hall with black surfaces, with
the sum over all lamps that this file computes by itself, machines in the way included: the largest error over the mean, and the share of points
outside of their `lux_within`.
"""
import csv
import json
import math
import pathlib
import random
import resource
import subprocess
import sys

LENGTH, WIDTH, HEIGHT, LAMPS_AT, LUMENS = 60.0, 40.0, 10.0, 9.5, 600e3


def machines():
    """Middle, half sides and height of each machine, m, and its turn, degrees."""
    rng = random.Random(11)
    return [(3.0 + 6.0 * (k % 10), 3.3 + 6.6 * (k // 10), rng.uniform(0.6, 1.8), rng.uniform(0.6, 1.8), rng.uniform(1.2, 4.0),
             rng.uniform(0.0, 90.0)) for k in range(60)]


def places(count):
    columns = max(1, round((count * LENGTH / WIDTH) ** 0.5))
    rows = -(-count // columns)
    return [((k % columns + 0.5) * LENGTH / columns, (k // columns + 0.5) * WIDTH / rows) for k in range(count)], LENGTH / columns


def scene(kind, count, is_black):
    grey = (lambda rho: 0 if is_black else rho)
    text = ['title = "hall"', 'unit = "m"']
    for name, rho in (("wall", 0.58), ("floor", 0.24), ("machine", 0.35)):
        text += [f"[materials.{name}]", f"reflectance = {grey(rho)}"]
    at, apart = places(count)
    if kind == "panel":
        text += ["[materials.panel]", "reflectance = 0", f"power = {LUMENS / 683.0:.9g}"]
    x, y, z = LENGTH, WIDTH, HEIGHT
    faces = {"floor": [[0, 0, 0], [x, 0, 0], [x, y, 0], [0, y, 0]], "ceiling": [[0, 0, z], [0, y, z], [x, y, z], [x, 0, z]],
             "south": [[0, 0, 0], [0, 0, z], [x, 0, z], [x, 0, 0]], "north": [[0, y, 0], [x, y, 0], [x, y, z], [0, y, z]],
             "west": [[0, 0, 0], [0, y, 0], [0, y, z], [0, 0, z]], "east": [[x, 0, 0], [x, 0, z], [x, y, z], [x, y, 0]]}
    for name, polygon in faces.items():
        text += ["[[surfaces]]", f'name = "{name}"', f'material = "{"floor" if name == "floor" else "wall"}"', f"polygon = {polygon}"]
    for k, (mx, my, sx, sy, sz, turn) in enumerate(machines()):
        text += ["[[surfaces]]", f'name = "machine{k}"', 'material = "machine"',
                 f"box = {{ min = [{-sx}, {-sy}, 0], max = [{sx}, {sy}, {sz}] }}", f"rotate = [0, 0, {turn}]", f"translate = [{mx}, {my}, 0]"]
    h = min(0.3, 0.2 * apart)
    for k, (px, py) in enumerate(at):
        if kind == "panel":
            square = [[px - h, py - h, LAMPS_AT], [px - h, py + h, LAMPS_AT], [px + h, py + h, LAMPS_AT], [px + h, py - h, LAMPS_AT]]
            text += ["[[surfaces]]", f'name = "panel{k}"', 'material = "panel"', f"polygon = {square}"]
            continue
        text += ["[[lamps]]", f'name = "lamp{k}"', f"position = [{px}, {py}, {LAMPS_AT}]", f"lumens = {LUMENS / count:.17g}"]
        if kind == "spot":
            text += ["cone = [25, 45]", "aim = [0, 0, -1]"]
    return "\n".join(text) + "\n"


def hidden(point, lamp, boxes):
    """True if a machine is between both points: slabs of a box, in the box's own axes."""
    for mx, my, sx, sy, sz, turn in boxes:
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        turned = [(c * (p[0] - mx) + s * (p[1] - my), -s * (p[0] - mx) + c * (p[1] - my), p[2]) for p in (point, lamp)]
        near, far = 0.0, 1.0
        for a, b, low, high in zip(turned[0], turned[1], (-sx, -sy, 0.0), (sx, sy, sz)):
            d = b - a if b != a else 1e-300
            near, far = max(near, min((low - a) / d, (high - a) / d)), min(far, max((low - a) / d, (high - a) / d))
        if near < far:
            return True
    return False


def probes(program, folder, count):
    """Largest error of 100 points over their mean light, and the share of points that are farther off than they say."""
    black = folder / "black.toml"
    black.write_text(scene("point", count, is_black=True))
    rng, points = random.Random(5), []
    # A vertical through a point meets a machine only if the point is in or below the machine.
    while len(points) < 100:
        x, y = rng.uniform(1.0, LENGTH - 1.0), rng.uniform(1.0, WIDTH - 1.0)
        if not hidden((x, y, 0.8), (x, y, LAMPS_AT), machines()):
            points.append((x, y, 0.8))
    table = folder / "points.csv"
    table.write_text("x,y,z,nx,ny,nz\n" + "".join(f"{x!r},{y!r},{z!r},0,0,1\n" for x, y, z in points))
    subprocess.run([program, "solve", black, "-o", folder / "black.vtp", "--refine", "off", "--quiet"], check=False)
    subprocess.run([program, "probe", black, folder / "black.vtp", "--points", table, "-o", folder / "lux.csv", "--quiet"], check=True)
    boxes, (at, _) = machines(), places(count)
    worst, outside, total = 0.0, 0, 0.0
    for point, row in zip(points, csv.DictReader((folder / "lux.csv").open())):
        lux = 0.0
        for px, py in at:
            d = (px - point[0], py - point[1], LAMPS_AT - point[2])
            if not hidden(point, (px, py, LAMPS_AT), boxes):
                lux += LUMENS / count / (4.0 * math.pi) * d[2] / (d[0] ** 2 + d[1] ** 2 + d[2] ** 2) ** 1.5
        off = abs(float(row["lux"]) - lux)
        total += lux
        worst = max(worst, off)
        # Unknown bounds are empty, as in the dark; the scene file's and the table's digits round.
        outside += off > float(row["lux_within"] or 0) + 1e-5 * lux
    mean = total / len(points)
    return worst / mean, outside / len(points)


def seconds_of(command, **options):
    """Processor seconds of a command, and what subprocess.run() returns of it."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    result = subprocess.run([str(word) for word in command], **options)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, result


def task_of(arguments, usage):
    """Program, folder (made), kind, counts and further options of a command line."""
    split = arguments.index("--") if "--" in arguments else len(arguments)
    if split < 4:
        sys.exit(usage)
    folder = pathlib.Path(arguments[1])
    folder.mkdir(parents=True, exist_ok=True)
    return arguments[0], folder, arguments[2], [int(word) for word in arguments[3:split]], arguments[split + 1:]


def main():
    program, folder, kind, counts, options = task_of(sys.argv[1:], __doc__)
    print(f"{kind:>8} {'seconds':>9} {'MB':>6} {'error':>8} {'elements':>9} {'probe':>9} {'outside':>8}")
    for count in counts:
        file = folder / f"{kind}{count}.toml"
        file.write_text(scene(kind, count, is_black=False))
        command = ["/usr/bin/time", "-f", "%M", program, "solve", file, "-o", folder / "hall.vtp", "--json", "--quiet", *options]
        spent, done = seconds_of(command, capture_output=True, text=True, check=False)
        report = json.loads(done.stdout)
        of_probe = probes(program, folder, count) if kind == "point" and count <= 10000 else None
        print(f"{count:8} {spent:9.1f} {int(done.stderr.split()[-1]) / 1024:6.0f} {100 * report['error_estimate']:7.2f}% {report['elements']:9}"
              + (f" {100 * of_probe[0]:8.3f}% {100 * of_probe[1]:7.0f}%" if of_probe else ""), flush=True)


if __name__ == "__main__":
    main()
