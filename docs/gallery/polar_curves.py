"""Draws polar curves of IES files with TILT=NONE as SVG: cd/klm in the planes C0-C180 and C90-C270.
Usage: polar_curves.py OUT.svg FILE.ies..."""
import math
import sys


def read(path):
    lines = open(path, encoding="latin-1").read().splitlines()
    tilt = next(i for i, line in enumerate(lines) if line.startswith("TILT="))
    numbers = [float(word) for line in lines[tilt + 1:] for word in line.replace(",", " ").split()]
    gammas, planes = int(numbers[3]), int(numbers[4])
    at = 13
    gamma = numbers[at:at + gammas]
    plane = numbers[at + gammas:at + gammas + planes]
    first = at + gammas + planes
    rows = [numbers[first + p * gammas:first + (p + 1) * gammas] for p in range(planes)]
    return gamma, plane, rows


def row_at(plane, rows, c):
    """The row of the plane nearest to C, after symmetry."""
    if len(plane) == 1:
        return rows[0]
    if plane[-1] == 90:
        c = min(c % 180, 180 - c % 180)
    elif plane[-1] == 180:
        c = min(c, 360 - c)
    return rows[min(range(len(plane)), key=lambda p: abs(plane[p] - c))]


def flux(gamma, plane, rows):
    """By the trapezoid rule; good enough to scale a drawing."""
    total = 0.0
    steps = 72
    for k in range(steps):
        row = row_at(plane, rows, 360.0 * k / steps)
        for i in range(len(gamma) - 1):
            ring = math.cos(math.radians(gamma[i])) - math.cos(math.radians(gamma[i + 1]))
            total += 0.5 * (row[i] + row[i + 1]) * ring * 2 * math.pi / steps
    return total


def curve(gamma, plane, rows, c, scale):
    points = []
    for side, sign in ((c + 180, -1), (c, 1)):
        row = row_at(plane, rows, side % 360)
        arm = [(sign * scale * v * math.sin(math.radians(g)), scale * v * math.cos(math.radians(g)))
               for g, v in zip(gamma, row)]
        points += arm[::-1] if sign < 0 else arm
    return points


def main(out, files):
    width, height, radius = 250, 250, 95
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width * len(files)}" '
             f'height="{height}" font-family="sans-serif" font-size="11">',
             f'<rect width="{width * len(files)}" height="{height}" fill="white"/>']
    for n, path in enumerate(files):
        gamma, plane, rows = read(path)
        per_klm = 1000.0 / flux(gamma, plane, rows)
        peak = max(map(max, rows)) * per_klm
        step = 10 ** math.floor(math.log10(peak))
        step = next(s for s in (0.2 * step, 0.5 * step, step, 2 * step) if peak / s <= 6)
        rings = math.ceil(peak / step)
        x0, y0, scale = width * (n + 0.5), 110, radius / (rings * step)
        for ring in range(1, rings + 1):
            parts.append(f'<circle cx="{x0}" cy="{y0}" r="{ring * step * scale:.2f}" fill="none" '
                         'stroke="#ddd"/>')
        parts.append(f'<text x="{x0 + 3}" y="{y0 + radius - 3}" fill="#888">{rings * step:g}</text>')
        for degrees in range(0, 360, 30):
            dx, dy = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
            parts.append(f'<line x1="{x0}" y1="{y0}" x2="{x0 + radius * dx:.2f}" '
                         f'y2="{y0 + radius * dy:.2f}" stroke="#eee"/>')
        for c, style in ((0, ''), (90, ' stroke-dasharray="5 3"')):
            points = " ".join(f"{x0 + x:.2f},{y0 + y:.2f}"
                              for x, y in curve(gamma, plane, rows, c, per_klm * scale))
            parts.append(f'<polyline points="{points}" fill="none" stroke="#c4501b" '
                         f'stroke-width="1.6"{style}/>')
        name = path.rsplit("/", 1)[-1]
        parts.append(f'<text x="{x0}" y="{height - 14}" text-anchor="middle">{name}</text>')
    parts.append("</svg>")
    with open(out, "w", encoding="utf-8") as file:
        file.write("\n".join(parts) + "\n")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
