#!/usr/bin/env python3
"""Lightwell on real rooms (Mitsuba scene files) beside the path tracer of Mitsuba 3: time, memory and error in one table.

  PYTHON bench/real_rooms.py LIGHTWELL FOLDER SIZE SAMPLES SCENE.xml... [-- OPTION...]

PYTHON is a Python 3.11 with Mitsuba 3 and numpy (PyPI: mitsuba, numpy). LIGHTWELL is the program; `OPTION...` go to `lightwell run`. FOLDER
gets copies of the scenes, pictures and reports. SIZE is WxH; the scene's camera keeps its field of view across. The references are two
pictures of SAMPLES paths a pixel each. With `--matt` before LIGHTWELL plastics are read as matt in both programs: their diffuse reflectance
stays, their gloss goes. (Mitsuba's rough plastics lose some percent of the light, Lightwell's none.)

Errors are those of means over squares of 8 x 8 pixels, luminance, relative to the mean of the references: sqrt(mean (P - A)(P - B)), which the
noise of the references A and B does not raise; and the median of |P / reference - 1|. Squares above eight times the median of the
reference are left out: they show lamps. Mitsuba's own error is sqrt(mean (A - B)^2 / 2). `equal` is the processor time of Mitsuba to
Lightwell's error over Lightwell's: a path tracer's error falls as 1 / sqrt(time). `mottle` is the error between 4 and 32 pixels, which eyes see
as blotches: that of means over 4 x 4 pixels less the error of means over 32 x 32, `slope`, which eyes forgive. `its own picture` compares with
TungstenRender.exr, if the scene's folder has one: bias and median of means over squares of a 32nd of the width.
"""
import json
import pathlib
import re
import resource
import subprocess
import sys

import numpy as np


def readable_copy(scene, folder, is_matt):
    """The scene as both programs read it, with diffuse materials in place of plastics if `is_matt`, beside links to its other files."""
    folder.mkdir(parents=True, exist_ok=True)
    for file in scene.parent.iterdir():
        link = folder / file.name
        if file.name != scene.name and not link.exists():
            link.symlink_to(file.resolve())
    lines, in_plastic = [], False
    of_gloss = re.compile(r'name="(alpha|distribution|nonlinear|(int|ext)_?ior|specular_?reflectance)"', re.IGNORECASE)
    for line in scene.read_text().splitlines():
        if "<bsdf" in line and is_matt:
            in_plastic = re.search(r'type="(rough)?plastic"', line) is not None
        if in_plastic and of_gloss.search(line):
            continue
        if in_plastic:
            line = re.sub(r'type="(rough)?plastic"', 'type="diffuse"', line)
            line = re.sub(r'name="diffuse_?[rR]eflectance"', 'name="reflectance"', line)
        if "</bsdf>" in line:
            in_plastic = False
        # A property of film that Mitsuba 3 no longer has, and integrators that it never had.
        if "highQualityEdges" not in line and "high_quality_edges" not in line:
            lines.append(re.sub(r'<integrator type="[^"]*"', '<integrator type="path"', line))
    copy = folder / scene.name
    copy.write_text("\n".join(lines))
    return copy


def with_facets(text):
    """The scene with the normals of facets on shapes of matt materials. Where normals are interpolated, a path tracer scatters light into
    directions below the facet, and what lies behind a wall, such as the sky, lights the room: 0.7 % of the living room's picture, and up to two
    fifths of the light on mouldings beside its windows."""
    of_gloss = re.compile(r'type="(rough|thin)?(conductor|dielectric|plastic)"')
    glossy = {match[1] for match in re.finditer(r'^\t<bsdf [^>]*id="([^"]*)".*?^\t</bsdf>', text, re.MULTILINE | re.DOTALL) if of_gloss.search(match[0])}

    def of_facets(match):
        names = set(re.findall(r'<ref [^>]*id="([^"]*)"', match[0]))
        if re.search("face_?normals", match[0], re.IGNORECASE) or of_gloss.search(match[0]) or names & glossy:
            return match[0]
        return match[1] + '<boolean name="face_normals" value="true"/>' + match[2]

    return re.sub(r'(<shape type="(?:obj|ply|serialized)"[^>]*>)(.*?</shape>)', of_facets, text, flags=re.DOTALL)


def comparable_copy(mi, file):
    """The scene as Mitsuba is to read it, beside `file`. A pixel is the mean over its square, as Lightwell's are: a wider filter spreads the
    light of windows over the squares beside them. Pictures with an alpha channel cover by that channel; Mitsuba would take their colours, and
    the white around a leaf for the leaf. Matt surfaces scatter by their facets."""
    def alpha_alone(match):
        picture = mi.Bitmap(str(file.parent / match[2]))
        if picture.pixel_format() != mi.Bitmap.PixelFormat.RGBA:
            return match[0]
        name = "alpha_of_" + match[2].replace("/", "_")
        mi.Bitmap(np.ascontiguousarray(np.array(picture)[..., 3:])).write(str(file.parent / name))
        return f'{match[1]}{name}"/>\n<boolean name="raw" value="true"/>'

    text = re.sub(r'(<rfilter [^>]*type=")[^"]*"', r'\1box"', file.read_text())
    text = re.sub(r'(<texture name="opacity" type="bitmap"\s*>\s*<string name="filename" value=")([^"]*)"\s*/>', alpha_alone, text)
    copy = file.with_name("comparable.xml")
    copy.write_text(with_facets(text))
    return copy


def seconds(who=resource.RUSAGE_SELF):
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


def mitsuba_picture(mi, file, width, height, samples, seed):
    """The picture as an array, and its processor seconds without reading the scene."""
    scene = mi.load_file(str(file))
    sensor = scene.sensors()[0]
    parameters = mi.traverse(sensor)
    parameters["film.size"] = [width, height]
    parameters.update()
    start = seconds()
    picture = mi.load_dict({"type": "path", "max_depth": 65}).render(scene, sensor=sensor, spp=samples, seed=seed)
    return np.array(picture, dtype=np.float64)[..., :3], seconds() - start


def luminance_of_squares(picture, side=8):
    """Luminance of means over squares of `side` pixels."""
    return means_of_squares(picture @ np.array([0.2126, 0.7152, 0.0722]), side)


def means_of_squares(values, side):
    """Means over squares of `side` x `side` values; what is left at the lower and right ends is not used."""
    height, width = values.shape[0] // side, values.shape[1] // side
    return values[:height * side, :width * side].reshape(height, side, width, side).mean((1, 3))


def mottle_and_slope(picture, references):
    """Error between 4 and 32 pixels, and above, of the mean luminance. Each is the root of a product of two differences from two
    references, whose noises are independent. Squares above eight times the median, lamps, count as right."""
    p, a, b = (luminance_of_squares(of, 4) for of in (picture, *references))
    shown = 0.5 * (a + b) < 8.0 * np.median(0.5 * (a + b))
    coarse, fine = [], []
    for reference in (a, b):
        error = np.where(shown, p - reference, 0.0)
        low = means_of_squares(error, 8)
        coarse.append(low)
        fine.append(error[:low.shape[0] * 8, :low.shape[1] * 8] - np.kron(low, np.ones((8, 8))))
    mean = 0.5 * (a + b)[shown].mean()
    return tuple(np.sqrt(max((x * y).mean(), 0.0)) / mean for x, y in (fine, coarse))


def beside_its_own(mi, picture, file):
    """Bias and median of a picture beside the reference that came with the scene, as text."""
    if not file.exists():
        return "-"
    reference = np.array(mi.Bitmap(str(file)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32), dtype=np.float64)
    columns = 32

    def squares(of):
        side = of.shape[1] // columns
        rows = of.shape[0] // side
        return of[:rows * side, :columns * side].reshape(rows, side, columns, side, 3).mean((1, 3, 4))

    ours, theirs = squares(picture), squares(reference)
    rows = min(len(ours), len(theirs))
    ours, theirs = ours[:rows], theirs[:rows]
    return f"{100.0 * (ours.mean() / theirs.mean() - 1.0):+.1f} %, {100.0 * np.median(np.abs(ours / theirs - 1.0)):.1f} %"


def lightwell_picture(mi, program, file, folder, size, options):
    """The picture of the first camera, processor seconds, and the report."""
    start = seconds(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "run", str(file), "-o", str(folder), "--size", size, "--quiet", *options], check=False)
    spent = seconds(resource.RUSAGE_CHILDREN) - start
    report = json.loads((folder / "report.json").read_text())
    picture = mi.Bitmap(str(sorted(folder.glob("*.exr"))[0])).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32)
    return np.array(picture, dtype=np.float64), spent, report


def main(arguments):
    is_matt = arguments[:1] == ["--matt"]
    arguments = arguments[1:] if is_matt else arguments
    if len(arguments) < 5:
        sys.exit(__doc__)
    options = arguments[arguments.index("--") + 1:] if "--" in arguments else []
    program, folder, size, samples, *scenes = arguments[:len(arguments) - len(options) - (1 if options else 0)]
    import mitsuba as mi
    mi.set_variant("scalar_rgb")
    width, height = (int(n) for n in size.split("x"))
    print("| scene | CPU s | MB | elements | bias | error | median | mottle | slope | Mitsuba: CPU s | error | equal | its own picture |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|---|")
    for scene in (pathlib.Path(s) for s in scenes):
        name = scene.parent.name
        home = pathlib.Path(folder) / name
        file = readable_copy(scene, home / "scene", is_matt)
        ours, spent, report = lightwell_picture(mi, program, file, home / "lightwell", size, options)
        theirs = comparable_copy(mi, file)
        pairs = [mitsuba_picture(mi, theirs, width, height, int(samples), seed) for seed in (1, 2)]
        a, b = (luminance_of_squares(picture) for picture, _ in pairs)
        p, reference = luminance_of_squares(ours), 0.5 * (a + b)
        shown = reference < 8.0 * np.median(reference)
        mean = reference[shown].mean()
        error = np.sqrt(max(((p - a) * (p - b))[shown].mean(), 0.0)) / mean
        their_error = np.sqrt((((a - b) ** 2)[shown] / 2.0).mean()) / mean
        median = np.median(np.abs(p / np.maximum(reference, 1e-12) - 1.0)[shown])
        mottle, slope = mottle_and_slope(ours, [picture for picture, _ in pairs])
        their_seconds = 0.5 * (pairs[0][1] + pairs[1][1])
        equal = their_seconds * (their_error / max(error, 1e-12)) ** 2 / spent
        print(f"| {name} | {spent:.0f} | {report['peak_memory_mb']:.0f} | {report['elements']} | "
              f"{100.0 * (p[shown].mean() / mean - 1.0):+.1f} % | {100.0 * error:.1f} % | {100.0 * median:.1f} % | "
              f"{100.0 * mottle:.1f} % | {100.0 * slope:.1f} % | "
              f"{their_seconds:.0f} | {100.0 * their_error:.1f} % | {equal:.2g} | "
              f"{beside_its_own(mi, ours, scene.parent / 'TungstenRender.exr')} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
