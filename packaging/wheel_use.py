"""Uses an installed wheel from reading a scene to an exported page, and checks what the process has loaded.

    python packaging/wheel_use.py SCENE
"""

import os
import sys
import tempfile

import numpy as np

import lightwell as lw

# The C and C++ libraries that every Linux has; NumPy brings its own others.
SYSTEM = ("ld-linux", "libc.", "libm.", "libpthread", "libdl.", "librt.", "libgcc_s", "libstdc++", "libutil", "libz.", "libcrypt")


def loaded_from_elsewhere():
    """Shared libraries in this process that are neither from the environment nor the system's C and C++ or Python."""
    with open("/proc/self/maps") as maps:
        files = {line.split()[-1] for line in maps if ".so" in line}
    # Of a Python in /usr the folder of its own modules alone: /usr/lib has everybody's libraries.
    version = "python%d.%d" % sys.version_info[:2]
    places = {os.path.realpath(sys.prefix), os.path.realpath(os.path.join(sys.base_prefix, "lib", version))}
    python = ("libpython", "lib-dynload", "libffi", "libbz2", "liblzma", "libssl", "libcrypto", "libexpat", "libsqlite3")
    return sorted(
        file
        for file in files
        if not any(os.path.realpath(file).startswith(place + os.sep) for place in places)
        and not os.path.basename(file).startswith(SYSTEM)
        and not any(word in file for word in python)
    )


def use(scene_file):
    scene = lw.read(scene_file)
    factors = lw.form_factors(scene)
    closure = np.asarray(factors.matrix.sum(axis=1)).ravel() + factors.open + factors.blocked
    assert abs(closure - 1.0).max() < 1e-5, "rows close but for the rounding of their float32 entries"
    solution = lw.solve(scene, max_patch_size=0.08, rays=256)
    assert solution.energy["emitted"] > 0.0
    assert np.isfinite(solution.probe([[0.3, 0.3, 0.3]], [0, 0, 1])).all()
    picture = solution.render(width=48, height=32, quality="draft")
    assert picture.shape == (32, 48, 3) and picture.max() > 0.0
    with tempfile.TemporaryDirectory() as folder:
        for name in ("s.vtp", "p.png", "model.glb", "model.html"):
            path = os.path.join(folder, name)
            {".vtp": solution.save, ".png": lambda p: lw.write_picture(p, picture)}.get(
                os.path.splitext(name)[1], solution.export
            )(path)
            assert os.path.getsize(path) > 0, name
        again = lw.load(os.path.join(folder, "s.vtp"), scene)
        assert again.irradiance.tobytes() == solution.irradiance.tobytes()


if __name__ == "__main__":
    use(sys.argv[1])
    strangers = loaded_from_elsewhere()
    if strangers:
        sys.exit("libraries from outside the environment are loaded: " + ", ".join(strangers))
    print(f"lightwell {lw.__version__} in Python {sys.version.split()[0]}: every step works, with the wheel's own libraries alone")
