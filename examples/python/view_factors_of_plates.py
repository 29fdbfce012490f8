"""View factors between two plates, beside the closed form (Howell's catalogue, C-11)."""

import sys
from math import atan, log, pi, sqrt

import lightwell as lw

width, depth, gap = 2.0, 1.0, 0.5  # m
vertices = [[x, y, z] for z in (0, gap) for x, y in ((0, 0), (width, 0), (width, depth), (0, depth))]
faces = [[0, 1, 2, 3], [7, 6, 5, 4]]  # counter-clockwise seen from the front: the plates face each other
scene = lw.Scene.from_arrays(vertices, faces, names=["floor", "ceiling"])

F, report = lw.form_factors(scene)

x, y = width / gap, depth / gap
expected = (
    2 / (pi * x * y)
    * (
        log(sqrt((1 + x**2) * (1 + y**2) / (1 + x**2 + y**2)))
        + x * sqrt(1 + y**2) * atan(x / sqrt(1 + y**2))
        + y * sqrt(1 + x**2) * atan(y / sqrt(1 + x**2))
        - x * atan(x)
        - y * atan(y)
    )
)
print(f"F_12 = {F[0, 1]:.7f}, closed form {expected:.7f}; estimated error {report['error_estimate']:.0e}")
print(f"{100 * (1 - F[0, 1]):.1f} % of the floor's radiation leaves between the plates")
# Two roundings to 32-bit floats.
sys.exit(int(abs(F[0, 1] - expected) > 2 * 2.0**-24))
