"""Finds the program `lightwell`, and runs it beside Blender with progress.

A process of its own keeps Blender responsive, gives its memory back when it ends, can be stopped at
any moment, and cannot take Blender down with it. The Python package would have to be built for the
very Python that Blender brings.
"""

import ctypes
import os
import queue
import re
import shutil
import signal
import subprocess
import sys
import threading
from typing import Callable, List, Optional, Tuple

VERSION = (0, 1)
"""Major and minor version of the program whose files the add-on reads."""

PROGRESS = re.compile(r"^(?P<phase>[^:]+): (?P<percent>\d+) %(?:, (?P<left>\d+) s left)?")
FINISHED = re.compile(r"^[^:]+: [\d.]+ s$")


class ProgramError(Exception):
    """The program is missing, of another version, or failed; the message is a sentence."""


def find_program(given: str) -> str:
    """The path of the program: the one given in the preferences, else the one on PATH.

    Raises ProgramError if there is none, or if it is of another version.
    """
    given = os.path.expanduser(given.strip())
    path = shutil.which(given) if given else shutil.which("lightwell")
    if not path:
        where = f"there is no program {given}" if given else "the program 'lightwell' is not on PATH"
        raise ProgramError(f"{where}; name it in the preferences of the add-on")
    check_version(path, version_text(path))
    return path


def version_text(path: str) -> str:
    """The first line of `lightwell --version`."""
    try:
        done = subprocess.run([path, "--version"], capture_output=True, text=True, timeout=20, check=False)
    except (OSError, subprocess.TimeoutExpired, UnicodeDecodeError) as error:
        raise ProgramError(f"{path} does not run ({error}); name another one in the preferences") from error
    return (done.stdout.splitlines() or [""])[0]


def check_version(path: str, text: str) -> None:
    """Raises ProgramError for a program of another name or version."""
    found = re.match(r"lightwell (\d+)\.(\d+)", text, re.IGNORECASE)
    if not found:
        raise ProgramError(f"{path} is not Lightwell; name another program in the preferences")
    if (int(found[1]), int(found[2])) != VERSION:
        wanted = ".".join(str(n) for n in VERSION)
        raise ProgramError(
            f"{path} is Lightwell {found[1]}.{found[2]}, and this add-on is made for {wanted}; install the "
            "add-on of that version, or name another program in the preferences"
        )


class Job:
    """A run of the program. `poll` tells how far it is; nothing here waits."""

    def __init__(self, arguments: List[str], folder: str):
        self.phase = "starting"
        self.share: Optional[float] = None
        self.notes: List[str] = []
        self.cancelled = False
        self._lines: "queue.Queue[Optional[str]]" = queue.Queue()
        self._ended = False
        if not os.path.isdir(folder):
            raise ProgramError(f"the folder {folder} is missing; solve again")
        own, other = _terminal()
        try:
            self._process = subprocess.Popen(
                arguments,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE if other is None else other,
                start_new_session=os.name == "posix",
                preexec_fn=_end_with_parent(),
            )
        except (OSError, subprocess.SubprocessError) as error:
            if own is not None:
                os.close(own)
            raise ProgramError(f"{arguments[0]} does not start ({getattr(error, 'strerror', error)})") from error
        finally:
            if other is not None:
                os.close(other)
        source = self._process.stderr.fileno() if own is None else own
        self._thread = threading.Thread(target=self._read, args=(source, own is not None), daemon=True)
        self._thread.start()

    def poll(self) -> Optional[int]:
        """The exit code once the run is over, else None; notes the lines that have come."""
        while True:
            try:
                line = self._lines.get_nowait()
            except queue.Empty:
                break
            if line is None:
                self._ended = True
            else:
                self._take(line)
        return self._process.poll() if self._ended else None

    def cancel(self) -> None:
        """Asks the program to end without a result; it leaves no part of a file."""
        self.cancelled = True
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        """Ends the program at once."""
        self.cancelled = True
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()

    def wait(self) -> int:
        """Waits for the end and returns the exit code."""
        self._thread.join()
        self._process.wait()
        code = self.poll()
        return self._process.returncode if code is None else code

    def failure(self, code: int) -> str:
        """Why there is no result, as a sentence; empty if there is one (exit codes 0 and 4)."""
        if self.cancelled:
            return "stopped; earlier light is as it was"
        if code in (0, 4):
            return ""
        if code < 0:
            return f"the program was ended by signal {-code} of the system, which happens where memory is short"
        errors = [line for line in self.notes if not line.startswith("note: ")]
        return errors[-1] if errors else f"the program ended with exit code {code} and no message"

    def _take(self, line: str) -> None:
        progress = PROGRESS.match(line)
        if progress:
            self.phase, self.share = progress["phase"], int(progress["percent"]) / 100.0
        elif line.endswith(" ..."):
            self.phase, self.share = line[:-4], None
        elif line and not FINISHED.match(line):
            self.notes.append(line)

    def _read(self, source: int, is_terminal: bool) -> None:
        rest = b""
        while True:
            try:
                block = os.read(source, 65536)
            except OSError:  # a terminal whose other end has closed
                block = b""
            if not block:
                break
            *lines, rest = re.split(rb"[\r\n]+", rest + block)
            # A line that is redrawn ends when the next one begins, which is too late.
            if is_terminal and PROGRESS.match(_plain(rest)):
                lines.append(rest)
            for line in lines:
                self._lines.put(_plain(line))
        if rest:
            self._lines.put(_plain(rest))
        if is_terminal:
            os.close(source)
        self._process.wait()
        self._lines.put(None)


def _plain(line: bytes) -> str:
    return re.sub(r"\x1b\[[0-9;]*[A-Za-z]", "", line.decode("utf-8", "replace")).strip()


def _end_with_parent() -> Optional[Callable[[], object]]:
    """Lets the system end the program where Blender crashes (Linux, prctl(2)); None elsewhere."""
    if not sys.platform.startswith("linux"):
        return None
    try:
        call = ctypes.CDLL(None).prctl
    except (OSError, AttributeError):
        return None
    set_death_signal = 1  # PR_SET_PDEATHSIG
    return lambda: call(set_death_signal, int(signal.SIGTERM))


def _terminal() -> Tuple[Optional[int], Optional[int]]:
    """A terminal for the program's messages, since it tells a pipe of finished phases only."""
    try:
        import pty

        return pty.openpty()
    except (ImportError, OSError):
        return None, None
