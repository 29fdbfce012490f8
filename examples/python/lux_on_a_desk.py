"""Lux on a desk under a luminous panel: mean, uniformity, and the share of reflected light."""

import sys

import numpy as np

import lightwell as lw


def rectangle(x, y, z, down=False):
    """Corners of a rectangle, its front upwards."""
    corners = [[x[0], y[0], z], [x[1], y[0], z], [x[1], y[1], z], [x[0], y[1], z]]
    return corners[::-1] if down else corners


room = [[4.0 * (i & 1), 3.0 * (i >> 1 & 1), 2.8 * (i >> 2)] for i in range(8)]
desk = rectangle((1.2, 2.8), (1.1, 1.9), 0.75)
panel = rectangle((1.7, 2.3), (1.2, 1.8), 2.7, down=True)
faces = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]]
faces += [[8, 9, 10, 11], [12, 13, 14, 15]]
lumens = 3400
exitance = lumens / 683 / 0.36  # W/m^2 in each band: white light of a watt in each band has 683 lm

scene = lw.Scene.from_arrays(
    np.array(room + desk + panel),
    faces,
    surface=[0] * 6 + [1, 2],
    names=["room", "desk", "panel"],
    reflectance=[0.6, 0.3, 0.0],
    emission=[0.0, 0.0, exitance],
)
solution = lw.solve(scene, accuracy="2%", channels="off")
print(solution)

x, y = np.meshgrid(np.linspace(1.3, 2.7, 8), np.linspace(1.2, 1.8, 4))
points = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, 0.75)])
lux = solution.lux_at(points, normals=[0, 0, 1])
print(f"desk: mean {lux.mean():.0f} lx, U0 {lux.min() / lux.mean():.2f}")

# In a room of one reflectance, reflected light averages rho Phi / ((1 - rho) A); A = 63.2 m^2. A desk
# below a panel gets more than half and less than twice of that.
dark = lw.solve(
    lw.Scene.from_arrays(
        scene.vertices, scene.faces, surface=scene.surface, reflectance=0.0,
        emission=[material.emission for material in scene.materials],
    ),
    refine="off",
)
reflected = lux - dark.lux_at(points, normals=[0, 0, 1])
mean = 0.6 * lumens / (0.4 * 63.2)
print(f"reflected light: {reflected.mean():.0f} lx, {100 * reflected.mean() / lux.mean():.0f} %")
sys.exit(int(not mean / 2 < reflected.mean() < 2 * mean))
