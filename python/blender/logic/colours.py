"""Colours of light, false colours of lux, and their scale."""

import math
from dataclasses import dataclass
from typing import List

import numpy as np

STOPS = np.array(
    [
        [0.16, 0.05, 0.36],
        [0.16, 0.29, 0.60],
        [0.08, 0.49, 0.58],
        [0.20, 0.66, 0.44],
        [0.63, 0.81, 0.27],
        [1.00, 0.93, 0.33],
    ]
)
"""sRGB; the stops of Lightwell's window and pages, whose lightness rises evenly."""


@dataclass(frozen=True)
class Scale:
    """Lux from the first colour to the last: linear from 0, else logarithmic."""

    low: float
    high: float

    def place(self, lux: np.ndarray) -> np.ndarray:
        """0 at the low end, 1 at the high end, and beyond them the ends."""
        lux = np.asarray(lux, float)
        if self.low <= 0.0:
            return np.clip(lux / self.high, 0.0, 1.0)
        ratio = np.log(np.maximum(lux, 1e-30) / self.low) / math.log(self.high / self.low)
        return np.clip(ratio, 0.0, 1.0)

    def steps(self) -> List[float]:
        """Values to label: 1, 2 and 5 times the powers of ten, or about five even ones from 0."""
        if self.low <= 0.0:
            step = _round_up(self.high / 5.0)
            return [step * i for i in range(int(self.high / step * 1.001) + 1)]
        is_long = self.high > 100.0 * self.low
        steps = []
        for power in range(math.floor(math.log10(self.low)), math.ceil(math.log10(self.high)) + 1):
            for factor in (1, 2, 5):
                value = factor * 10.0**power
                is_end = value <= 1.001 * self.low or value >= 0.999 * self.high
                if 0.999 * self.low <= value <= 1.001 * self.high and (factor == 1 or is_end or not is_long):
                    steps.append(value)
        return steps


def scale_of(lux: np.ndarray) -> Scale:
    """A scale for these values: round ends, without the brightest 0.5 % and the darkest 2 %, three decades at most."""
    lit = np.sort(lux[(lux > 0) & np.isfinite(lux)])
    if len(lit) == 0:
        return Scale(0.0, 1.0)
    high = _round_up(float(lit[int(0.995 * (len(lit) - 1))]))
    low = 1.0 / _round_up(1.0 / max(float(lit[int(0.02 * (len(lit) - 1))]), high / 1000.0))
    return Scale(low if low < high else high / 10.0, high)


def _round_up(value: float) -> float:
    """1, 2 or 5 times a power of ten that is no less."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(f * power for f in (1.0, 2.0, 5.0, 10.0) if f * power >= value * (1 - 1e-9))


def false_colours(lux: np.ndarray, scale: Scale) -> np.ndarray:
    """(n, 3) sRGB, 0 to 1."""
    x = scale.place(lux) * (len(STOPS) - 1)
    i = np.minimum(x.astype(int), len(STOPS) - 2)
    return STOPS[i] + (x - i)[:, None] * (STOPS[i + 1] - STOPS[i])


def light_colours(light: np.ndarray) -> np.ndarray:
    """(n, 3) linear, 0 to 1: x / (1 + x) of the brightest band, x = 1 at twice the mean of what is lit."""
    brightest = light.max(axis=1)
    lit = brightest[brightest > 0]
    # The median keeps lamps, which are few and very bright, from darkening the room.
    white = 2.0 * float(np.median(lit)) if len(lit) else 1.0
    return light / (white + brightest)[:, None]


def linear(srgb: np.ndarray) -> np.ndarray:
    """Linear values of sRGB (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def encoded(values: np.ndarray) -> np.ndarray:
    """sRGB, 0 to 1, of linear values (IEC 61966-2-1)."""
    inside = np.clip(np.nan_to_num(values), 0.0, 1.0)
    return np.where(inside <= 0.0031308, 12.92 * inside, 1.055 * inside ** (1 / 2.4) - 0.055)


def lux_text(lux: float) -> str:
    """Three digits and the unit."""
    if lux >= 1000.0:
        return f"{float(f'{lux:.3g}'):.0f} lx"
    return f"{lux:.3g} lx"


def bilinear(corners: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Weights of the corners of a triangle or a flat quadrilateral, (k, 3), for a point within it."""
    edges = corners - corners[0]
    normal = np.cross(edges[1], edges[2] if len(corners) == 3 else corners[3] - corners[1])
    axis = int(np.argmax(np.abs(normal)))
    keep = [k for k in range(3) if k != axis]
    flat, place = corners[:, keep], point[keep]
    if len(corners) == 3:
        u, v = np.linalg.solve(np.column_stack([flat[1] - flat[0], flat[2] - flat[0]]), place - flat[0])
        return np.array([1 - u - v, u, v])
    s = t = 0.5
    for _ in range(8):  # Newton's method; one step for a parallelogram
        weights = np.array([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
        along = (1 - t) * (flat[1] - flat[0]) + t * (flat[2] - flat[3])
        across = (1 - s) * (flat[3] - flat[0]) + s * (flat[2] - flat[1])
        ds, dt = np.linalg.solve(np.column_stack([along, across]), place - weights @ flat)
        s, t = min(max(s + ds, 0.0), 1.0), min(max(t + dt, 0.0), 1.0)
    return np.array([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])


