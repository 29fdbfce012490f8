"""The built program as a child process, with limits and signals."""

import os
import resource
import signal
import subprocess
import time

# Exit codes that docs/command-line.md lists.
DONE, FAILED, WRONG_USAGE, BAD_INPUT, SHORT, INTERRUPTED = 0, 1, 2, 3, 4, 130
DOCUMENTED = {DONE, FAILED, WRONG_USAGE, BAD_INPUT, SHORT, INTERRUPTED}
# A command of this suite takes a second or two; a command that takes this long hangs.
LONGEST = 120.0


class Ended:
    """Exit code (negative: the signal that ended the process), output and seconds of a command."""

    def __init__(self, code, out, err, seconds):
        self.code, self.out, self.err, self.seconds = code, out, err, seconds

    def last_words(self):
        lines = [line for line in self.err.strip().splitlines() if line]
        return lines[-1][:300] if lines else "(no message)"


class Program:
    def __init__(self, path):
        self.path = os.path.abspath(path)

    def run(self, words, folder, limits=(), signal_number=None, delay=0.0, until=None, out=None, err=None):
        """Runs the command in `folder`. `limits`: pairs of a resource and its value. With `signal_number` the process
        gets that signal `delay` seconds after its start, or after the function `until` was true. `out` and `err` are
        files for standard output and standard error."""

        def limit():
            for name, value in limits:
                resource.setrlimit(name, (value, resource.getrlimit(name)[1]))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

        start = time.monotonic()
        child = subprocess.Popen([self.path, *words], cwd=folder, stdin=subprocess.DEVNULL,
                                 stdout=out or subprocess.PIPE, stderr=err or subprocess.PIPE, preexec_fn=limit)
        if signal_number is not None:
            while until and not until() and child.poll() is None:
                time.sleep(0.0002)
            time.sleep(delay)
            child.send_signal(signal_number)
            start = time.monotonic()
        try:
            texts = child.communicate(timeout=LONGEST)
            code = child.returncode
        except subprocess.TimeoutExpired:
            child.kill()
            texts = child.communicate()
            code = -signal.SIGALRM
        said = [(text or b"").decode(errors="replace") for text in texts]
        return Ended(code, said[0], said[1], time.monotonic() - start)


def fault_of(ended, allowed=DOCUMENTED):
    """The reason why an end breaks the promises of docs/command-line.md; empty: none."""
    if ended.code == -signal.SIGALRM:
        return f"hangs: no end after {LONGEST:.0f} s"
    if ended.code < 0:
        return f"ended by signal {signal.Signals(-ended.code).name}: {ended.last_words()}"
    if ended.code not in allowed:
        return f"exit code {ended.code}: {ended.last_words()}"
    if ended.code in (FAILED, WRONG_USAGE, BAD_INPUT):
        errors = [line for line in ended.err.splitlines() if line.startswith("error: ")]
        # A sentence has at least a subject and a predicate.
        if not errors or len(errors[0].split()) < 4:
            return f"exit code {ended.code} without a sentence: {ended.last_words()}"
    return ""
