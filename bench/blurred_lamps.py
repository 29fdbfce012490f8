#!/usr/bin/env python3
"""Depth of field and motion blur below ten to many thousand lamps: time and error of pictures in one table.

  python3 bench/blurred_lamps.py LIGHTWELL FOLDER KIND COUNT... [-- OPTION...]

The hall of many_lamps.py, one of whose machines turns and slides, as a sharp picture, through a wide lens and with an open shutter, 80 x 50 pixels.
`seconds` are processor time of `lightwell render`, less that of a picture of one pixel; `OPTION...` go to it. `error` is the root mean square
error of pixels over the mean, beside a picture of 1024 samples of every pixel with a noise of 0.4 %, and `mean` the difference of the means;
the sharp picture, whose pixels are other means, has neither. Pixels in which luminous panels are seen are left out.
"""
import json
import subprocess
import sys

from many_lamps import scene, seconds_of, task_of

CAMERAS = {"still": "", "lens": "aperture_radius = 0.15\nfocus_distance = 8\n", "shutter": "shutter = [-0.2, 0.2]\n"}
LAMPS = "0.1"  # W/(m^2 sr): no surface sends on as much, but the ceiling beside lamps
MOTION = """
[motions.slide]
pivot = [9, 9.9, 0]
keys = [{ time = -1, degrees = -90, translate = [-4, 0, 0] }, { time = 0 }, { time = 1, degrees = 90, translate = [4, 0, 0] }]
"""


def blurred_scene(kind, count):
    text = scene(kind, count, is_black=False).replace('name = "machine11"', 'name = "machine11"\nmotion = "slide"') + MOTION
    for name, blur in CAMERAS.items():
        text += f'[[cameras]]\nname = "{name}"\nposition = [1, 6.6, 4.5]\nlook_at = [30, 17, 1.5]\nup = [0, 0, 1]\nfov = 70\n{blur}'
    return text


def main():
    program, folder, kind, counts, options = task_of(sys.argv[1:], __doc__)
    print(f"{kind:>8} {'camera':>8} {'seconds':>8} {'error':>8} {'mean':>8}")
    for count in counts:
        file, solution = folder / f"{kind}{count}.toml", folder / f"{kind}{count}.vtp"
        file.write_text(blurred_scene(kind, count))
        seconds_of([program, "solve", file, "-o", solution, "--refine", "off", "--quiet"], check=True)
        for camera in CAMERAS:
            picture, reference = folder / f"{kind}{count}_{camera}.exr", folder / f"{kind}{count}_{camera}_reference.exr"
            render = [program, "render", file, solution, "--camera", camera, "--quiet", "--size"]
            if CAMERAS[camera] and not reference.exists():
                seconds_of(render + ["80x50", "--samples", "1024", "--noise", "0.4%", "-o", reference], check=True)
            least, _ = seconds_of(render + ["1x1", "-o", picture], check=True)
            spent = seconds_of(render + ["80x50", "-o", picture, *options], check=True)[0] - least
            if not CAMERAS[camera]:
                print(f"{count:8} {camera:>8} {spent:8.2f}", flush=True)
                continue
            done = subprocess.run([program, "compare", picture, reference, "--exclude-above", LAMPS, "--json"], capture_output=True, text=True, check=True)
            found = json.loads(done.stdout)
            mean = found["mean"] / found["reference_mean"] - 1.0
            print(f"{count:8} {camera:>8} {spent:8.2f} {100 * found['relative_rmse']:7.2f}% {100 * mean:+7.3f}%", flush=True)


if __name__ == "__main__":
    main()
