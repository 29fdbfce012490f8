"""IFC models as scene files: python -m lightwell.ifc model.ifc -o room.toml"""

import argparse
import sys
from typing import List, Optional

from ._errors import Error
from ._ifc import convert_ifc


def main(arguments: Optional[List[str]] = None) -> int:
    """Returns the exit code: 0; 3 for wrong input, after a sentence on standard error."""
    parser = argparse.ArgumentParser(
        prog="python -m lightwell.ifc",
        description="Writes an IFC model as a scene file of Lightwell, with its geometry beside it.",
        epilog="Example: python -m lightwell.ifc office.ifc --fixtures fixtures.csv -o office.toml",
    )
    parser.add_argument("model", metavar="MODEL.ifc", help="IFC2X3 or IFC4")
    parser.add_argument("-o", "--output", metavar="SCENE.toml", required=True, help="the scene file")
    parser.add_argument("--fixtures", metavar="FILE.csv", help="columns fixture, file: photometric files")
    parser.add_argument("--materials", metavar="FILE.csv", help="columns material, reflectance, transmittance")
    parser.add_argument(
        "--height", metavar="METRES", type=float, default=0.8, help="of the plane of each space (default 0.8)"
    )
    given = parser.parse_args(arguments)
    try:
        notes = convert_ifc(
            given.model, given.output, fixtures=given.fixtures, materials=given.materials, height=given.height
        )
    except Error as error:
        print(f"error: {error}", file=sys.stderr)
        return 3
    for note in notes:
        print(f"note: {note}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
