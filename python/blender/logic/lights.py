"""Blender's lights in radiometric units, and the lamps and surfaces of a scene file that they become.

Blender's watts are radiant flux (Blender manual, "Light Objects"; the factors below are those of
Cycles): a point of P watts has the intensity P / (4 pi) W/sr to all sides, a spot the same within
its cone, whatever the cone's angle, and an area of P watts is a Lambertian emitter of that flux. A
sun has W/m^2 across its rays. Colours multiply these in each band.
"""

import math
from dataclasses import dataclass
from typing import Callable, Dict, List, Optional, Sequence, Tuple

LUMINANCE = (0.2126729, 0.7151522, 0.0721750)
"""Y of linear Rec. 709 red, green and blue with the solver's digits; adds up to 1 (ITU-R BT.709)."""

STEP = 0.1  # degrees between the intensities that are written for a spot or a narrowed area
RIM_STEPS = 64  # at least, where a spot's light falls
DARK_AFTER = 1e-4  # degrees from the last light to the dark, since files are linear between angles


@dataclass(frozen=True)
class Light:
    """A light as Blender has it, in metres, watts and degrees, with its place in the world."""

    name: str
    kind: str
    """"POINT", "SPOT", "AREA" or "SUN"."""
    energy: float
    """W; of a sun W/m^2. Without `normalized`, W for each m^2 of the light's surface, times pi for a sun. As in Cycles,
    a sun without a disc is then as with `normalized`, and a point without a radius 4 times as bright."""
    colour: Tuple[float, float, float] = (1.0, 1.0, 1.0)
    """Factors of red, green and blue, those of a colour temperature included."""
    position: Tuple[float, float, float] = (0.0, 0.0, 0.0)
    x_axis: Tuple[float, float, float] = (1.0, 0.0, 0.0)
    y_axis: Tuple[float, float, float] = (0.0, 1.0, 0.0)
    aim: Tuple[float, float, float] = (0.0, 0.0, -1.0)
    exposure: float = 0.0
    normalized: bool = True
    radius: float = 0.0
    shape: str = "SQUARE"
    """Of an area: "SQUARE", "RECTANGLE", "DISK" or "ELLIPSE"."""
    size: Tuple[float, float] = (0.0, 0.0)
    """Of an area: metres along `x_axis` and `y_axis`."""
    spread: float = 180.0
    cone: float = 45.0
    """Of a spot: the full angle."""
    blend: float = 0.15
    angle: float = 0.526
    """Of a sun: the full angle of its disc."""
    photometry: Optional[str] = None
    """Name of the photometric file below the scene's folder."""
    factor: float = 1.0


def watts(light: Light) -> Tuple[float, float, float]:
    """Radiant flux in each band, W; of a sun the irradiance across its rays, W/m^2.

    A spot has the flux that it would have without its cone.
    """
    power = light.energy * 2.0**light.exposure
    if not light.normalized:
        power *= _surface(light)
    return tuple(power * c for c in light.colour)


def _surface(light: Light) -> float:
    if light.kind == "SUN":
        return math.pi * math.radians(light.angle / 2) ** 2 if light.angle > 0.0 else 1.0
    if light.kind != "AREA":
        return 4 * math.pi * light.radius**2 if light.radius > 0.0 else 4.0
    return light.size[0] * light.size[1] * (1.0 if light.shape in ("SQUARE", "RECTANGLE") else math.pi / 4)


def luminous(values: Sequence[float]) -> float:
    """The sum of three bands as eyes weigh them: 1 for (1, 1, 1)."""
    return sum(y * value for y, value in zip(LUMINANCE, values))


def shines(light: Light) -> bool:
    """True if the light gives light that eyes see."""
    if light.photometry is not None:
        return light.factor * luminous(light.colour) > 0.0
    return luminous(watts(light)) > 0.0


def candela_of(light: Light, lumens_per_watt: float) -> float:
    """Luminous intensity of a point, and of a spot on its axis: I = lumens_per_watt P / (4 pi)."""
    return lumens_per_watt * luminous(watts(light)) / (4 * math.pi)


def spot_share(light: Light, gamma: float) -> float:
    """Share of a spot's full intensity `gamma` degrees off its axis, as in Cycles.

    Smoothstep of (cos gamma - cos h) / (blend (1 - cos h)) with h half of the cone's angle.
    """
    edge = math.cos(math.radians(light.cone / 2))
    above = math.cos(math.radians(gamma)) - edge
    soft = max(light.blend, 0.0) * (1.0 - edge)
    if soft == 0.0:
        return 1.0 if gamma <= light.cone / 2 else 0.0
    if above <= 0.0:
        return 0.0
    if above >= soft:
        return 1.0
    t = above / soft
    return t * t * (3.0 - 2.0 * t)


def spot_rim(light: Light) -> float:
    """Degrees off a spot's axis from which on its intensity falls."""
    edge = math.cos(math.radians(light.cone / 2))
    return math.degrees(math.acos(min(edge + max(light.blend, 0.0) * (1.0 - edge), 1.0)))


def spread_intensity(light: Light, gamma: float) -> float:
    """Intensity of an area of 1 W, W/sr, `gamma` degrees off its axis, narrowed to its spread as in Cycles.

    I = cos gamma / pi (tan h - tan gamma) / (tan h - h) with h half of the spread, which keeps the flux.
    """
    h = math.radians(light.spread / 2)
    theta = math.radians(gamma)
    if theta >= h:
        return 0.0
    return math.cos(theta) / math.pi * (math.tan(h) - math.tan(theta)) / (math.tan(h) - h)


def ies_text(name: str, edge: float, candela: Callable[[float], float], rim: float = 0.0) -> str:
    """A photometric file (IES LM-63-2002) of an intensity that is the same in all planes.

    edge: degrees from the axis from which on there is no light, more than 0 and up to 90.
    candela: intensity at an angle from the axis, degrees.
    rim: degrees from the axis to where the intensity begins to fall; steps are as fine as the rest needs.
    """
    gammas = _angles(0.0, rim, STEP) + _angles(rim, edge, min(STEP, (edge - rim) / RIM_STEPS)) + [edge]
    values = [candela(gamma) for gamma in gammas]
    if edge < 90.0 - 2 * DARK_AFTER:  # files end at 90 or 180 degrees
        gammas += [edge + DARK_AFTER, 90.0]
        values += [0.0, 0.0]
    else:
        gammas[-1] = 90.0
    lines = [
        "IESNA:LM-63-2002",
        f"[LUMINAIRE] {name}",
        "TILT=NONE",
        f"1 -1 1 {len(gammas)} 1 1 2 0 0 0",
        "1 1 0",
    ]
    lines += _rows(gammas) + ["0"] + _rows(values)
    return "\n".join(lines) + "\n"


def _angles(low: float, high: float, most: float) -> List[float]:
    """Even angles from `low` on, without `high`, whose steps are `most` at most; none in less than 1e-6 degrees."""
    if high - low < 1e-6:
        return []
    count = math.ceil((high - low) / most)
    return [low + (high - low) * i / count for i in range(count)]


def _rows(values: Sequence[float]) -> List[str]:
    words = [f"{value:.9g}" for value in values]
    return [" ".join(words[i : i + 10]) for i in range(0, len(words), 10)]


def is_surface(light: Light) -> bool:
    """True if the light becomes an emitting surface: an area that shines to all sides of its front."""
    return light.kind == "AREA" and light.spread >= 179.9 and light.photometry is None


ROUND_CORNERS = 64


def outline(light: Light) -> List[Tuple[float, float, float]]:
    """Corners of an area light, counter-clockwise seen from where it shines; round ones keep their area."""
    if light.shape in ("SQUARE", "RECTANGLE"):
        corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.5, -0.5)]
    else:
        turn = 2 * math.pi / ROUND_CORNERS
        radius = 0.5 * math.sqrt(turn / math.sin(turn))
        corners = [
            (radius * math.cos(turn * i), -radius * math.sin(turn * i)) for i in range(ROUND_CORNERS)
        ]
    a, b = light.size
    return [
        tuple(
            p + a * u * x + b * v * y for p, x, y in zip(light.position, light.x_axis, light.y_axis)
        )
        for u, v in corners
    ]


def lamp_table(light: Light, lumens_per_watt: float) -> Tuple[Dict[str, object], Optional[str]]:
    """Keys of `[[lamps]]` for a light that is no surface, and the text of a photometric file that it needs."""
    table: Dict[str, object] = {"name": light.name, "position": list(light.position)}
    power = watts(light)
    if light.photometry is not None:
        # Cycles turns C0 to the light's -y.
        table.update(
            file=light.photometry,
            aim=list(light.aim),
            c0=[-c for c in light.y_axis],
            factor=light.factor,
            colour=list(light.colour),
        )
        return table, None
    if light.kind == "POINT":
        table["power"] = [float(p) for p in power]
        return table, None
    flux = lumens_per_watt * luminous(power)
    table.update(aim=list(light.aim), c0=list(light.x_axis), colour=list(light.colour))
    if light.kind == "SPOT":
        full = flux / (4 * math.pi)
        text = ies_text(light.name, light.cone / 2, lambda gamma: full * spot_share(light, gamma), spot_rim(light))
        return table, text
    text = ies_text(light.name, light.spread / 2, lambda gamma: flux * spread_intensity(light, gamma))
    table.update(opening=list(light.size), round=light.shape in ("DISK", "ELLIPSE"))
    return table, text


def spoken(light: Light, lumens_per_watt: float) -> str:
    """The light's watts in the units of lighting design, as a sentence."""
    if light.photometry is not None:
        return f"{light.name}: flux and intensities of {light.photometry.split('/')[-1]}; its watts do not count"
    value = luminous(watts(light))
    if light.kind == "SUN":
        return f"{light.name}: {_round(value)} W/m², {_round(lumens_per_watt * value)} lx across its rays"
    said = f"{light.name}: {_round(value)} W radiant"
    if light.kind == "AREA":
        return f"{said}, {_round(lumens_per_watt * value)} lm"
    candela = _round(candela_of(light, lumens_per_watt))
    if light.kind == "POINT":
        return f"{said}, {_round(lumens_per_watt * value)} lm, {candela} cd to all sides"
    return f"{said}, {candela} cd on its axis; the cone takes none of the rest's watts"


def _round(value: float) -> str:
    return f"{value:.4g}" if value < 1e4 else f"{value:.0f}"
