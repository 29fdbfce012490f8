#!/usr/bin/env python3
"""Lightwell beside the path tracer of Mitsuba 3 on a Cornell box: processor seconds to the same error.

  PYTHON bench/mitsuba_race.py SCENE.toml REFERENCE-A.exr REFERENCE-B.exr PICTURE.exr SECONDS [SAMPLES]

PYTHON is a Python 3.11 with Mitsuba 3 and numpy (PyPI: mitsuba, numpy). SCENE.toml is one of cornell/. The references are two
independent pictures of the scene, or one picture given twice. PICTURE.exr is Lightwell's picture, and SECONDS the processor seconds of
solving and rendering (user and system, see time(1)). Mitsuba renders SAMPLES (64) per pixel. The error of a picture P is
sqrt(mean (P - A)(P - B)) / mean of the references, without the light and three pixels around the light: pixel by pixel if the references are
as large as the picture, otherwise in means over squares. A path tracer's error falls as 1 / sqrt(samples) and its time grows as the samples:
its time to Lightwell's error is its time x (its error / Lightwell's)^2. The printed factor is the ratio of that time to SECONDS. Kernels are
compiled before the clock starts.
"""
import os
import resource
import sys
import tomllib

import numpy as np


def seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def mitsuba_material(mi, material):
    def rgb(value):
        return {"type": "rgb", "value": value if isinstance(value, list) else [value] * 3}

    if "glass" in material:
        return {"type": "dielectric", "int_ior": material["glass"]["ior"], "ext_ior": 1.0}
    if "specular" in material:
        return {"type": "conductor", "material": "none"}
    return {"type": "diffuse", "reflectance": rgb(material.get("reflectance", 0))}


def mitsuba_mesh(mi, name, polygon, holes, bsdf, emitter):
    """A quadrilateral as two triangles; with a hole of four corners, as eight around it."""
    vertices, faces = list(polygon), [[0, 1, 2], [0, 2, 3]]
    if holes:
        hole = holes[0]
        # Each corner of the hole is joined with the nearest of the outside.
        start = min(range(4), key=lambda i: np.linalg.norm(np.subtract(hole[i], polygon[0])))
        turn = 1 if np.linalg.norm(np.subtract(hole[(start + 1) % 4], polygon[1])) < np.linalg.norm(
            np.subtract(hole[(start - 1) % 4], polygon[1])) else -1
        vertices += [hole[(start + turn * i) % 4] for i in range(4)]
        faces = []
        for i in range(4):
            j = (i + 1) % 4
            faces += [[i, j, 4 + j], [i, 4 + j, 4 + i]]
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf)
    if emitter:
        properties["emitter"] = mi.load_dict(emitter)
    mesh = mi.Mesh(name, len(vertices), len(faces), props=properties)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = np.ravel(np.array(vertices, dtype=np.float32))
    parameters["faces"] = np.ravel(np.array(faces, dtype=np.uint32))
    parameters.update()
    return mesh


def mitsuba_scene(mi, file):
    with open(file, "rb") as stream:
        scene = tomllib.load(stream)
    camera = scene["cameras"][0]
    position, direction = np.array(camera["position"]), np.array(camera["direction"])
    result = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": -1},
        "sensor": {
            "type": "perspective", "fov": camera["fov"],
            "to_world": mi.ScalarTransform4f().look_at(position.tolist(), (position + direction).tolist(), camera["up"]),
            "film": {"type": "hdrfilm", "width": camera["size"][0], "height": camera["size"][1], "rfilter": {"type": "box"},
                     "pixel_format": "rgb"},
            "sampler": {"type": "independent"},
        },
    }
    for surface in scene["surfaces"]:
        material = scene["materials"][surface["material"]]
        bsdf, emitter = mitsuba_material(mi, material), None
        if "radiance" in material:
            emitter = {"type": "area", "radiance": {"type": "rgb", "value": material["radiance"]}}
        if "sphere" in surface:
            sphere = surface["sphere"]
            result[surface["name"]] = {"type": "sphere", "center": sphere["center"], "radius": sphere["radius"], "bsdf": bsdf}
        else:
            result[surface["name"]] = mitsuba_mesh(mi, surface["name"], surface["polygon"], surface.get("holes"), bsdf, emitter)
    return mi.load_dict(result)


def read(mi, file):
    bitmap = mi.Bitmap(file).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    return np.array(bitmap).astype(float)


def error(picture, A, B):
    light = ((A + B) / 2).max(2) > 3.4
    size = picture.shape[0] // A.shape[0]
    P = picture.reshape(A.shape[0], size, A.shape[1], size, 3).mean((1, 3))
    for _ in range(3 if size == 1 else 1):
        grown = light.copy()
        for axis in (0, 1):
            for step in (-1, 1):
                grown |= np.roll(light, step, axis)
        light = grown
    square = ((P - A) * (P - B))[~light].mean()
    return np.sqrt(max(square, 0.0)) / ((A + B) / 2)[~light].mean()


def main():
    if len(sys.argv) not in (6, 7):
        sys.exit(__doc__)
    import mitsuba as mi
    mi.set_variant(os.environ.get("MITSUBA_VARIANT", "llvm_ad_rgb"))
    file, reference_a, reference_b, picture, ours = sys.argv[1:6]
    samples = int(sys.argv[6]) if len(sys.argv) == 7 else 64
    A, B = read(mi, reference_a), read(mi, reference_b)
    scene = mitsuba_scene(mi, file)
    np.array(mi.render(scene, spp=min(samples, 64), seed=1))  # compiles
    start, left, total, run = seconds(), samples, 0.0, 0
    while left > 0:
        now = min(left, 64)
        total = total + now * np.array(mi.render(scene, spp=now, seed=100 + run)).astype(float)
        left, run = left - now, run + 1
    theirs = seconds() - start
    e_ours, e_theirs = error(read(mi, picture), A, B), error(total / samples, A, B)
    print(f"Lightwell  {float(ours):8.1f} s  {100 * e_ours:.2f} %")
    print(f"Mitsuba    {theirs:8.1f} s  {100 * e_theirs:.2f} %  ({samples} samples per pixel)")
    factor = theirs / float(ours) * (e_theirs / e_ours) ** 2
    print(f"Mitsuba would take {factor:.1f} times Lightwell's processor seconds to its error")


if __name__ == "__main__":
    main()
