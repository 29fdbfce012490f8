"""Solving scenes, and reading solutions."""

import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

import numpy as np

from . import _lightwell
from ._arrays import checked_progress, directions_of, points_of, set_options
from ._camera import Camera
from ._errors import InputError
from ._scene import Progress, Scene
from ._solution import Path, Solution

Onlooker = Union[Camera, str, "os.PathLike[str]", np.ndarray]
"""Somebody or something that looks at the scene: see `solve`."""


def solve(
    scene: Scene,
    *,
    accuracy: Union[float, str, None] = None,
    seconds: Optional[float] = None,
    max_patch_size: Optional[float] = None,
    max_element_size: Optional[float] = None,
    elements_per_patch_edge: Optional[int] = None,
    discontinuity: bool = False,
    form_factors: str = "auto",
    hemicube_resolution: Optional[int] = None,
    solver: str = "auto",
    rays: Optional[int] = None,
    refine: Union[float, str, None] = None,
    max_elements: Optional[int] = None,
    gather_rays: Optional[int] = None,
    tolerance: Optional[float] = None,
    max_sweeps: Optional[int] = None,
    channels: Union[str, Mapping[str, str]] = "kinds",
    memory: Optional[float] = None,
    start_from: Optional[Solution] = None,
    look_from: Union[Onlooker, Sequence[Onlooker]] = (),
    checkpoint: Optional[Path] = None,
    resume: bool = False,
    keep_checkpoint: bool = False,
    every: Optional[float] = None,
    reuse: Optional[Path] = None,
    progress: Optional[Progress] = None,
) -> Solution:
    """Meshes a scene and solves for the light on its surfaces, as `lightwell solve` does.

    accuracy: target of the estimated error: a share of the mean irradiance (0.01 or "1%"), or "5lx".
    seconds: the best solution within this time.
    max_patch_size, max_element_size: longest edges, metres (about 1600 patches; half a patch).
    elements_per_patch_edge: 1 to 64 (2).
    discontinuity: cut receivers along the bounds of shadows.
    form_factors: "auto", "ray-cast", "hemicube" or "analytic".
    solver: "auto", "gauss-seidel", "jacobi", "sor", "southwell", "cg", "bicgstab", "gmres" or
        "progressive".
    rays, gather_rays: powers of two: of each patch (512), of each vertex (1024 or fewer).
    refine: error of interpolation at which elements are no longer split (0.7 %), or "off".
    tolerance, max_sweeps: of the solver (1e-5, 500).
    channels: light that is kept apart for `Solution.relight`: "kinds", "per-luminaire", "off", or
        patterns of emitters by channel, {"desk": "desk lamp*"}.
    memory: most bytes of the process; rows beyond it go to a file in the working folder.
    start_from: a solution of the same geometry whose light the solver starts from.
    look_from: spends effort on what these see, and estimates the error there: cameras, names of the
        scene's, (n, 6) arrays of places (x, y, z and the direction that each faces, metres), .csv files
        of such places, or "everywhere".
    checkpoint: file that keeps finished work, so that a solve that was stopped can go on. Removed when
        the solution is whole, unless keep_checkpoint.
    resume: continue from the checkpoint, if there is one; the solution has the bits of one that was not
        stopped.
    every: seconds after which finished work is safe on the disk (10).
    reuse: kept checkpoint of another solve of the same geometry, for its form factors.
    progress: called with the phase and the share done; False stops the work.

    With the same options the arrays have the same bits as those of the command line's solution.
    Ctrl-C raises KeyboardInterrupt within about a second; then there is no solution.

    Raises InputError, e.g. for a scene without light, or a checkpoint of another scene or other options;
    Error where a checkpoint cannot be written; Interrupted after False.
    """
    asked = {name: value for name, value in locals().items() if name not in ("scene", "progress")}
    if not isinstance(scene, Scene):
        raise InputError(f"scene is {scene!r}; give a lightwell.Scene")
    options = _options_of(scene, asked)
    return Solution(_lightwell.solve(scene._data, options, checked_progress(progress)))


def load(path: Path, scene: Optional[Scene] = None) -> Solution:
    """Reads a solution (.vtp), made here or by the command line.

    scene: its scene, which pictures, gathers at points and models with names need.

    Raises InputError for a file that is no solution, is damaged, or is of another scene.
    """
    if scene is not None and not isinstance(scene, Scene):
        raise InputError(f"scene is {scene!r}; give a lightwell.Scene")
    return Solution(_lightwell.load(os.fspath(path), None if scene is None else scene._data))


def _options_of(scene: Scene, asked: Dict[str, Any]) -> "_lightwell.SolveOptions":
    """The compiled options for the arguments of `solve` by name."""
    _refuse_contradictions(asked)
    options = _lightwell.SolveOptions()
    options.text = _options_text(asked)
    solver, start = asked["solver"], asked.pop("start_from")
    _set_onlookers(options, scene, asked.pop("look_from"))
    for name in ("checkpoint", "reuse"):
        if asked[name] is not None:
            asked[name] = os.fspath(asked[name])
    _set_channels(options, asked.pop("channels"))
    set_options(options, asked, shares=["accuracy", "refine"])
    if solver not in _lightwell.solver_names():
        names = ", ".join(_lightwell.solver_names())
        raise InputError(f"there is no solver '{solver}'; choose from: {names}")
    if start is not None:
        if not isinstance(start, Solution):
            raise InputError(f"start_from is {start!r}; give a lightwell.Solution")
        options.start = start._data
    return options


def _refuse_contradictions(asked: Mapping[str, Any]) -> None:
    for decides in ("accuracy", "seconds"):
        if asked[decides] is None:
            continue
        for other in ("gather_rays", "refine"):
            if asked[other] is not None and asked[other] != "off":
                raise InputError(f"{decides} decides over {other}; give only one of the two")
    if asked["checkpoint"] is None:
        for name in ("resume", "keep_checkpoint"):
            if asked[name]:
                raise InputError(f"{name} needs checkpoint, the file of finished work")
    elif asked["seconds"] is not None:
        raise InputError("seconds and checkpoint exclude each other; give only one of them")
    elif asked["reuse"] is not None:
        raise InputError("checkpoint and reuse exclude each other; give only one of them")
    if asked["max_element_size"] is not None and asked["elements_per_patch_edge"] is not None:
        raise InputError(
            "max_element_size and elements_per_patch_edge contradict each other; give only one of them"
        )


def _options_text(asked: Mapping[str, Any]) -> str:
    unsaid = ("start_from", "look_from", "checkpoint", "resume", "keep_checkpoint", "every", "reuse", "memory")
    said = {name: value for name, value in asked.items() if value is not None and name not in unsaid}
    if names := [_onlooker_name(onlooker) for onlooker in _onlookers(asked["look_from"])]:
        said["look_from"] = names
    return f"lightwell.solve(scene, {', '.join(f'{name}={value!r}' for name, value in said.items())})"


def _onlookers(look_from: Any) -> List[Any]:
    is_one = isinstance(look_from, (str, os.PathLike, Camera, np.ndarray)) or not hasattr(look_from, "__iter__")
    return [look_from] if is_one else list(look_from)


def _onlooker_name(onlooker: Any) -> str:
    if isinstance(onlooker, np.ndarray):
        return f"{len(onlooker) if onlooker.ndim else 0} places"
    return onlooker.name if isinstance(onlooker, Camera) else str(onlooker)


def _set_onlookers(options: "_lightwell.SolveOptions", scene: Scene, look_from: Any) -> None:
    for onlooker in _onlookers(look_from):
        if isinstance(onlooker, Camera):
            options.look_from_camera(onlooker._compiled(scene._data))
        elif isinstance(onlooker, (str, os.PathLike)):
            name = os.fspath(onlooker)
            if name.lower().endswith(".csv"):
                options.look_from_file(scene._data, name)
            else:
                options.look_from_name(scene._data, name)
        elif isinstance(onlooker, np.ndarray) and onlooker.ndim == 2 and onlooker.shape[1] == 6:
            places = points_of("look_from", onlooker[:, :3])
            options.look_from_points(places, directions_of("look_from", onlooker[:, 3:], len(places)))
        else:
            raise InputError(
                f"look_from has {onlooker!r}; give a lightwell.Camera, the name of a camera, an (n, 6) array of "
                "places with their directions, a .csv file of such places, or 'everywhere'"
            )


def _set_channels(options: "_lightwell.SolveOptions", channels: Any) -> None:
    if isinstance(channels, Mapping):
        for name, pattern in channels.items():
            options.add_channel(str(name), str(pattern))
    elif channels in ("kinds", "per-luminaire", "off"):
        options.channels = channels
    else:
        raise InputError(
            f"channels is {channels!r}; give 'kinds', 'per-luminaire', 'off', or patterns of emitters by "
            "channel, such as {'desk': 'desk lamp*'}"
        )
