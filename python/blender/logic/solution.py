"""Reads a solution (.vtp) of Lightwell into arrays: the mesh, and the light of each channel on it."""

import re
import xml.etree.ElementTree as xml
import zlib
from dataclasses import dataclass
from typing import Dict, List, Sequence, Tuple

import numpy as np

TYPES = {
    "Int8": "<i1", "UInt8": "<u1", "Int16": "<i2", "UInt16": "<u2", "Int32": "<i4", "UInt32": "<u4",
    "Int64": "<i8", "UInt64": "<u8", "Float32": "<f4", "Float64": "<f8", "String": "<u1",
}  # fmt: skip

DARK = 1e-4
"""Share of the mean illuminance of what is lit below which an element is outside of rooms, within bodies or below
walls; as `lightwell export` and the window."""
SIDE_STEP = 0.0005  # metres between a side and its place where both sides are lit; as `lightwell export`


class SolutionError(Exception):
    """A file that is no solution; the message is a sentence."""


@dataclass
class Solution:
    """A solved scene: elements of three or four corners, and light at their vertices."""

    points: np.ndarray
    """(n, 3), metres."""
    corners: np.ndarray
    first: np.ndarray
    """Element e has the vertices corners[first[e]:first[e + 1]]."""
    normals: np.ndarray
    """(n, 3) unit, on the side that the elements face."""
    channels: List[str]
    flux: np.ndarray
    """(channels,) lumens emitted by each as solved."""
    irradiance: np.ndarray
    """(channels, n, 3), W/m^2 per band."""
    radiosity: np.ndarray
    """(channels, n, 3), W/m^2 per band."""
    lumens: np.ndarray
    """(3,) lumens of one watt in each band."""
    error: float
    """Estimated relative error of irradiance; 0 if it was not estimated."""

    def lux(self, levels: Sequence[float]) -> np.ndarray:
        """Illuminance at the vertices with the channels at these levels."""
        return _sum(levels, self.irradiance) @ self.lumens

    def light(self, levels: Sequence[float]) -> np.ndarray:
        """(n, 3) radiosity at the vertices."""
        return _sum(levels, self.radiosity)


def _sum(levels: Sequence[float], values: np.ndarray) -> np.ndarray:
    return np.tensordot(np.asarray(levels, np.float32), values, axes=1)


def read_solution(path: str) -> Solution:
    """Reads a solution as `lightwell solve` writes it; sides that are dark are left out.

    Raises SolutionError for other files, and for scenes of spectral bands.
    """
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        raise SolutionError(f"{path} cannot be read ({error.strerror}); solve again") from error
    if not data.startswith(b"<?lightwell-solution format=\"1\""):
        raise SolutionError(f"{path} is no solution of this version of Lightwell; solve again")
    try:
        arrays = _arrays(data)
        return _solution(arrays)
    except (KeyError, ValueError, IndexError, zlib.error, xml.ParseError) as error:
        raise SolutionError(f"{path} is damaged or of another version ({error}); solve again") from error


Arrays = Dict[Tuple[str, str], np.ndarray]


def _arrays(data: bytes) -> Arrays:
    """The arrays of a VTK XML file by the section that they stand in and their name."""
    begin = data.index(b"<AppendedData")
    raw = data.index(b"_", data.index(b">", begin)) + 1
    head = data[data.index(b"<VTKFile") : begin].decode("utf-8") + "</VTKFile>"
    root = xml.fromstring(re.sub(r"<\?.*?\?>", "", head))
    if root.get("header_type") != "UInt64" or root.get("compressor") != "vtkZLibDataCompressor":
        raise ValueError("its arrays are not packed as Lightwell does")
    found: Arrays = {}
    for section in root.iter():
        for item in section:
            if item.tag in ("DataArray", "Array"):
                found[section.tag, item.get("Name", "")] = _array(data, raw, item)
    return found


def _array(data: bytes, raw: int, item: xml.Element) -> np.ndarray:
    at = raw + int(item.get("offset", "-1"))
    blocks, size, last = (int(n) for n in np.frombuffer(data, "<u8", 3, at))
    packed = np.frombuffer(data, "<u8", blocks, at + 24)
    at += 24 + 8 * blocks
    parts = []
    for length in packed:
        parts.append(zlib.decompress(data[at : at + int(length)]))
        at += int(length)
    values = np.frombuffer(b"".join(parts), TYPES[item.get("type", "")])
    columns = int(item.get("NumberOfComponents", "1"))
    return values if columns == 1 else values.reshape(-1, columns)


def _strings(values: np.ndarray) -> List[str]:
    return [text.decode("utf-8", "replace") for text in values.tobytes().split(b"\0")[:-1]]


def _solution(arrays: Arrays) -> Solution:
    fields = {name: value for (section, name), value in arrays.items() if section == "FieldData"}
    if _strings(fields["band_names"]) != ["r", "g", "b"]:
        raise ValueError("its bands are not red, green and blue")
    lumens = float(fields["lumens_per_watt"][0]) * fields["band_xyz"][:, 1].astype(float)
    corners, ends = arrays["Polys", "connectivity"], arrays["Polys", "offsets"]
    first = np.concatenate([[0], ends]).astype(np.int64)
    names = _strings(fields["channel_names"]) if "channel_names" in fields else ["all light"]
    light = _Light(arrays, fields, first, corners)
    irradiance = np.stack([light.irradiance(c) for c in range(len(names))])
    radiosity = np.stack([light.radiosity(c, irradiance[c]) for c in range(len(names))])
    result = Solution(
        arrays["Points", "Points"] if ("Points", "Points") in arrays else light.points(),
        corners.astype(np.int64),
        first,
        arrays["PointData", "normal"],
        names,
        light.watts(len(names)) @ lumens,
        irradiance,
        radiosity,
        lumens,
        max(float(fields["error_estimate"][0]), 0.0),
    )
    return _shown(result, arrays["CellData", "twin"])


class _Light:
    """Light of the channels at the vertices, with every scale 1."""

    def __init__(self, arrays: Arrays, fields: Dict[str, np.ndarray], first: np.ndarray, corners: np.ndarray):
        self.arrays = arrays
        self.fields = fields
        sizes = np.diff(first)
        # A vertex belongs to one side of one surface, so any of its elements names the patch.
        self.patch = np.zeros(len(arrays["PointData", "normal"]), np.int64)
        self.patch[corners] = np.repeat(arrays["CellData", "patch"], sizes)
        self.has_channels = "channel_names" in fields

    def points(self) -> np.ndarray:
        return next(value for (section, _), value in self.arrays.items() if section == "Points")

    def irradiance(self, channel: int) -> np.ndarray:
        if not self.has_channels:
            return self.arrays["PointData", "irradiance"]
        head = f"channel_{channel}_"
        direct = self.arrays["PointData", head + "direct_irradiance"]
        return direct + self.arrays["PointData", head + "indirect_irradiance"]

    def radiosity(self, channel: int, irradiance: np.ndarray) -> np.ndarray:
        """B = M + rho E; of sheets that let light through the mean of the patch, which has both sides' light."""
        if not self.has_channels:
            return self.arrays["PointData", "radiosity"]
        emission = np.zeros_like(self.fields["patch_reflectance"])
        if "patch_full_emission" in self.fields:
            of_channel = self.fields["patch_channel"] == channel
            emission[of_channel] = self.fields["patch_full_emission"][of_channel]
        result = emission[self.patch] + self.fields["patch_reflectance"][self.patch] * irradiance
        if "patch_transmittance" in self.fields:
            lets_through = self.fields["patch_transmittance"].max(axis=1)[self.patch] > 0
            means = self.fields[f"channel_{channel}_patch_radiosity"]
            result[lets_through] = means[self.patch[lets_through]]
        return result

    def watts(self, channels: int) -> np.ndarray:
        """(channels, 3) emitted in each band."""
        name = "channel_energy_emitted_absorbed_escaped_unshot"
        if name in self.fields:
            return self.fields[name][:, 0].reshape(channels, 3)
        return (self.fields["patch_emission"] * self.fields["patch_area"][:, None]).sum(axis=0)[None]


def dark_limit(light: np.ndarray, areas: np.ndarray) -> float:
    """The light, in the units given, of an element that is still dark. Means are by area: lamps have many small
    elements in bright light, and little area."""
    lit = light > 0.0
    return DARK * float(np.average(light[lit], weights=areas[lit] + 1e-30)) if lit.any() else 0.0


def element_areas(points: np.ndarray, corners: np.ndarray, first: np.ndarray) -> np.ndarray:
    """(elements,) areas in the square of the unit of the points: half of the sum of crosses about the first corner."""
    begin = points[np.repeat(corners[first[:-1]], np.diff(first))].astype(float)
    following = np.arange(1, len(corners) + 1)
    following[first[1:] - 1] = first[:-1]
    crosses = np.cross(points[corners] - begin, points[corners[following]] - begin)
    return 0.5 * np.linalg.norm(np.add.reduceat(crosses, first[:-1], axis=0), axis=1)


def _largest(values: np.ndarray, solution: Solution) -> np.ndarray:
    return np.maximum.reduceat(values[solution.corners], solution.first[:-1])


def _shown(solution: Solution, twin: np.ndarray) -> Solution:
    """The sides that are lit or shine, so that one can look into a closed room from outside. Where both
    sides of one place are, each is moved a little along its normal."""
    sizes = np.diff(solution.first)
    bands = solution.irradiance.sum(axis=0).max(axis=1)
    limit = dark_limit(_largest(bands, solution), element_areas(solution.points, solution.corners, solution.first))
    # Sides that shine are shown, even where no light falls.
    keep = _largest(np.maximum(bands, solution.radiosity.sum(axis=0).max(axis=1)), solution) > limit
    if not keep.any():
        keep[:] = True
    both = keep & np.where(twin >= 0, keep[twin], False)
    moved = np.zeros(len(solution.points), bool)
    moved[solution.corners[np.repeat(both, sizes)]] = True
    points = solution.points + SIDE_STEP * moved[:, None] * solution.normals
    used, corners = np.unique(solution.corners[np.repeat(keep, sizes)], return_inverse=True)
    solution.points, solution.normals = points[used], solution.normals[used]
    solution.corners = corners.reshape(-1)
    solution.first = np.concatenate([[0], np.cumsum(sizes[keep])])
    solution.irradiance = solution.irradiance[:, used]
    solution.radiosity = solution.radiosity[:, used]
    return solution
