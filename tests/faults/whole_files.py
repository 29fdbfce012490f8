"""Whether a result is whole, and whether two results hold the same bits."""

import hashlib
import json
import re
import struct
import xml.etree.ElementTree
import zlib


def vtk_arrays(content):
    """The arrays of a VTK file as {(place, name): bytes}; `seconds`, which no two runs share, is left out."""
    at = content.index(b'<AppendedData encoding="raw">')
    begin = content.index(b"_", at) + 1
    head = content[content.index(b"<VTKFile"):at].decode() + "</VTKFile>"
    arrays = {}
    for parent in xml.etree.ElementTree.fromstring(head).iter():
        for array in parent.findall("DataArray") + parent.findall("Array"):
            name = array.get("Name")
            if "seconds" in name:
                continue
            here = begin + int(array.get("offset"))
            blocks, _, _ = struct.unpack_from("<QQQ", content, here)
            sizes = struct.unpack_from(f"<{blocks}Q", content, here + 24)
            here += 24 + 8 * blocks
            data = b""
            for size in sizes:
                data += zlib.decompress(content[here:here + size])
                here += size
            arrays[parent.tag, name] = data
    return arrays


COURSE = ("seconds", "peak_memory_mb", "storage", "threads", "files", "scene", "options", "checkpoint",
          "picture_checkpoint", "notes", "solver", "refinement", "refined", "unlit")


def without_times(value):
    """JSON without what differs between two runs: times, memory, files, and the course of a solve that a resumed `run`
    found finished."""
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if key not in COURSE}
    return [without_times(item) for item in value] if isinstance(value, list) else value


def digest(name, content):
    """A value that two whole files share if and only if they hold the same results. Throws where a file is torn."""
    if name.endswith(".vtp"):
        held = repr(sorted(vtk_arrays(content).items())).encode()
    elif name.endswith(".json"):
        held = json.dumps(without_times(json.loads(content)), sort_keys=True).encode()
    else:
        held = content
    return hashlib.sha256(held).hexdigest()


def check_png(content):
    """Throws unless the content is a PNG file with sound checksums up to its end."""
    if content[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("the file is no PNG")
    at, kind = 8, b""
    while kind != b"IEND":
        size, kind = struct.unpack_from(">I4s", content, at)
        (checksum,) = struct.unpack_from(">I", content, at + 8 + size)
        if zlib.crc32(content[at + 4:at + 8 + size]) != checksum:
            raise ValueError("a checksum of the PNG is wrong")
        at += 12 + size
    if at != len(content):
        raise ValueError("bytes follow the end of the PNG")


LEFTOVER = re.compile(r"^(.+)\.\d+\.part$")
