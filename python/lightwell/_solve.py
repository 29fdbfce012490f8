"""Solving scenes, and reading solutions."""

import os
from typing import Any, Dict, Mapping, Optional, Union

from . import _lightwell
from ._arrays import checked_progress, set_options
from ._errors import InputError
from ._scene import Progress, Scene
from ._solution import Path, Solution


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
    progress: called with the phase and the share done; False stops the work.

    With the same options the arrays have the same bits as those of the command line's solution.
    Ctrl-C raises KeyboardInterrupt within about a second; then there is no solution.

    Raises InputError, e.g. for a scene without light, and Interrupted after False.
    """
    asked = {name: value for name, value in locals().items() if name not in ("scene", "progress")}
    if not isinstance(scene, Scene):
        raise InputError(f"scene is {scene!r}; give a lightwell.Scene")
    options = _options_of(asked)
    return Solution(_lightwell.solve(scene._data, options, checked_progress(progress)))


def load(path: Path, scene: Optional[Scene] = None) -> Solution:
    """Reads a solution (.vtp), made here or by the command line.

    scene: its scene, which pictures, gathers at points and models with names need.

    Raises InputError for a file that is no solution, is damaged, or is of another scene.
    """
    if scene is not None and not isinstance(scene, Scene):
        raise InputError(f"scene is {scene!r}; give a lightwell.Scene")
    return Solution(_lightwell.load(os.fspath(path), None if scene is None else scene._data))


def _options_of(asked: Dict[str, Any]) -> "_lightwell.SolveOptions":
    """The compiled options for the arguments of `solve` by name."""
    _refuse_contradictions(asked)
    options = _lightwell.SolveOptions()
    options.text = _options_text(asked)
    solver, start = asked["solver"], asked.pop("start_from")
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
    if asked["max_element_size"] is not None and asked["elements_per_patch_edge"] is not None:
        raise InputError(
            "max_element_size and elements_per_patch_edge contradict each other; give only one of them"
        )


def _options_text(asked: Mapping[str, Any]) -> str:
    said = {name: value for name, value in asked.items() if value is not None and name != "start_from"}
    return f"lightwell.solve(scene, {', '.join(f'{name}={value!r}' for name, value in said.items())})"


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
