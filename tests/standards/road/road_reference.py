#!/usr/bin/env python3
"""Figures of the roads of road_figures_test.cpp, from the formulas of docs/road.md alone.

The program shares no code with Lightwell: it reads the photometric file and the r-tables itself,
and sums luminaire by luminaire. Run it in the root of the repository:

    python3 tests/standards/road/road_reference.py

It prints, for each road, L_m, U_o, U_l and f_TI of each lane from the right, E_m and E_min of the
carriageway, and R_EI of the right and the left edge, with 8 digits.
"""

import csv
from bisect import bisect_right
from math import acos, atan2, ceil, cos, degrees, floor, hypot, radians, sin, sqrt, tan


def interval(knots, x):
    i = min(max(bisect_right(knots, x) - 1, 0), len(knots) - 2)
    return i, (x - knots[i]) / (knots[i + 1] - knots[i])


def bilinear(rows, columns, values, a, b):
    i, s = interval(rows, a)
    k, t = interval(columns, b)
    return ((1 - s) * ((1 - t) * values[i][k] + t * values[i][k + 1])
            + s * ((1 - t) * values[i + 1][k] + t * values[i + 1][k + 1]))


def read_ies(path):
    """Angles C, angles gamma, and candela by C and gamma, of a file with TILT=NONE."""
    text = open(path).read().split("TILT=NONE", 1)[1].split()
    numbers = [float(word) for word in text]
    factor, count_gamma, count_c = numbers[2], int(numbers[3]), int(numbers[4])
    rest = numbers[13:]
    gamma, rest = rest[:count_gamma], rest[count_gamma:]
    c, rest = rest[:count_c], rest[count_c:]
    table = [[factor * cd for cd in rest[i * count_gamma:(i + 1) * count_gamma]]
             for i in range(count_c)]
    return c, gamma, table


def read_surface(name):
    lines = list(csv.reader(open("standards/road/r_tables.csv")))
    beta = [float(x) for x in lines[0][2:]]
    own = [[float(x) for x in line[1:]] for line in lines[1:] if line and line[0] == name]
    return [row[0] for row in own], beta, [[1e-4 * r for r in row[1:]] for row in own]


class Lights:
    """All luminaires of a road; `rows` are (y, facing, first x)."""

    def __init__(self, road, web):
        self.road, self.web = road, web
        tilt = radians(road["tilt"])
        self.placed = []
        for y, facing, first in road["rows"]:
            street = (0.0, cos(tilt) * facing, sin(tilt))
            zenith = (0.0, -sin(tilt) * facing, cos(tilt))
            along = facing  # C0 is street x zenith, which points along x
            spacing = road["spacing"]
            for k in range(floor(-700 / spacing), ceil(700 / spacing) + 2):
                self.placed.append((first + k * spacing, y, street, zenith, along))

    def candela(self, lamp, way):
        d = sqrt(sum(w * w for w in way))
        unit = [w / d for w in way]
        dot = lambda a: sum(x * y for x, y in zip(a, unit))
        street, zenith, along = lamp[2:]
        angle = degrees(atan2(dot(street), along * unit[0])) % 360.0
        gamma = degrees(acos(max(-1.0, min(1.0, -dot(zenith)))))
        c, gammas, table = self.web
        if gamma > gammas[-1]:
            return 0.0
        return self.road["factor"] * bilinear(c, gammas, table, angle, gamma)

    def lux(self, x, y):
        height, total = self.road["height"], 0.0
        for lamp in self.placed:
            way = (x - lamp[0], y - lamp[1], -height)
            if abs(way[0]) > 5 * height or abs(way[1]) > 5 * height:
                continue
            d = sqrt(sum(w * w for w in way))
            total += self.candela(lamp, way) * height / d**3
        return total

    def luminance(self, x, y, eye):
        height, total = self.road["height"], 0.0
        tangents, beta, r = self.road["surface"]
        sight = (x - eye[0], y - eye[1])
        forward = 1.0 if sight[0] > 0 else -1.0
        for lamp in self.placed:
            to = (lamp[0] - x, lamp[1] - y)
            if not -5 * height <= forward * to[0] <= 12 * height or abs(to[1]) > 5 * height:
                continue
            tangent = hypot(*to) / height
            if tangent > tangents[-1]:
                continue
            angle = degrees(atan2(abs(sight[0] * to[1] - sight[1] * to[0]),
                                  sight[0] * to[0] + sight[1] * to[1]))
            total += (bilinear(tangents, beta, r, tangent, angle)
                      * self.candela(lamp, (-to[0], -to[1], -height)) / height**2)
        return total

    def veil(self, eye, forward):
        total, look = 0.0, (forward * cos(radians(1)), 0.0, -sin(radians(1)))
        for lamp in self.placed:
            to = (lamp[0] - eye[0], lamp[1] - eye[1], self.road["height"] - eye[2])
            ahead = forward * to[0]
            if not 0 < ahead <= 500 or to[2] > ahead * tan(radians(20)):
                continue
            d = sqrt(sum(w * w for w in to))
            cosine = min(1.0, sum(a * b for a, b in zip(to, look)) / d)
            theta = degrees(acos(cosine))
            if not 0.1 <= theta <= 60:
                continue
            lux = self.candela(lamp, tuple(-w for w in to)) * cosine / d**2
            if theta > 1.5:
                total += 9.86 * (1 + (23 / 66.4)**4) * lux / theta**2
            else:
                total += (10 / theta**3 + 5 * (1 + (23 / 62.5)**4) / theta**2) * lux
        return total


def middles(low, length, count):
    return [low + (i + 0.5) * length / count for i in range(count)]


def mean(values):
    return sum(values) / len(values)


def columns(road):
    spacing = road["spacing"]
    count = 10 if spacing <= 30 else ceil(spacing / 3 - 1e-9)
    return middles(0.0, spacing, count)


def strip_lux(lights, right, width):
    rows = max(3, ceil(width / 1.5 - 1e-9))
    return [lights.lux(x, y) for y in middles(right, width, rows) for x in columns(lights.road)]


def driver(lights, lane):
    road = lights.road
    spacing, wide = road["spacing"], road["width"] / road["lanes"]
    forward = -1.0 if lane >= road["lanes"] - road["oncoming"] else 1.0
    y = (lane + 0.5) * wide
    eye = (-60.0 if forward > 0 else spacing + 60.0, y, 1.5)
    xs = columns(road)
    seen = [[lights.luminance(x, row, eye) for x in xs]
            for row in middles(0.0, road["width"], 3 * road["lanes"])]
    everywhere = [value for row in seen for value in row]
    middle = seen[3 * lane + 1]
    L = mean(everywhere)
    start = 2.75 * (road["height"] - 1.5)
    begin = -start if forward > 0 else spacing + start
    step = spacing / len(xs)
    veil = max(lights.veil((begin + forward * i * step, y, 1.5), forward)
               for i in range(len(xs)))
    f_TI = 65 * veil / L**0.8 if L <= 5 else 95 * veil / L**1.05
    return L * road["maintenance"], min(everywhere) / L, min(middle) / max(middle), f_TI


def print_road(title, road, web):
    lights = Lights(road, web)
    print(title)
    for lane in range(road["lanes"]):
        print("  lane", lane + 1, *(f"{x:.8g}" for x in driver(lights, lane)))
    lux = [road["maintenance"] * x for x in strip_lux(lights, 0.0, road["width"])]
    wide = road["width"] / road["lanes"]
    edge = road["width"]
    right = mean(strip_lux(lights, -wide, wide)) / mean(strip_lux(lights, 0.0, wide))
    left = mean(strip_lux(lights, edge, wide)) / mean(strip_lux(lights, edge - wide, wide))
    print("  lux", f"{mean(lux):.8g} {min(lux):.8g}", "edges", f"{right:.8g} {left:.8g}")


def main():
    web = read_ies("examples/road/luminaires/street.ies")
    street = {"width": 7.0, "lanes": 2, "oncoming": 1, "surface": read_surface("R3"),
              "rows": [(0.5, 1.0, 0.0)], "spacing": 29.0, "height": 8.0, "tilt": 0.0,
              "maintenance": 0.8, "factor": 1.0}
    print_road("street", street, web)
    print_road("staggered, R2",
               {**street, "width": 7.5, "oncoming": 0, "surface": read_surface("R2"),
                "rows": [(1.0, 1.0, 0.0), (6.5, -1.0, 20.0)], "spacing": 40.0, "height": 9.0,
                "tilt": 10.0, "maintenance": 0.75}, web)
    print_road("median of 3 m, C2",
               {**street, "oncoming": 0, "surface": read_surface("C2"),
                "rows": [(6.5, -1.0, 0.0), (10.5, 1.0, 0.0)], "spacing": 32.0, "height": 10.0}, web)
    print_road("single-left, bright, R1",
               {**street, "surface": read_surface("R1"), "rows": [(6.5, -1.0, 0.0)], "tilt": 5.0,
                "factor": 10.0}, web)


if __name__ == "__main__":
    main()
