"""Long calls: progress, interruption, several threads."""

import os
import signal
import subprocess
import sys
import threading
import unittest

import lightwell as lw
from scenes import CORNELL, lit_room

# Minutes of work, unless somebody stops it.
LONG = {"max_patch_size": 0.004, "gather_rays": 4096}


class Progress(unittest.TestCase):
    def test_is_called_on_the_calling_thread(self):
        calls = []
        lw.solve(
            lit_room(),
            gather_rays=64,
            progress=lambda phase, share: calls.append((threading.get_ident(), phase, share)),
        )
        self.assertEqual({thread for thread, _, _ in calls}, {threading.get_ident()})
        self.assertTrue(all(0 <= share <= 1 for _, _, share in calls))
        phases = [phase for _, phase, _ in calls]
        for phase in ("mesh", "form factors", "solve", "gather"):
            self.assertIn(phase, phases)

    def test_false_stops(self):
        with self.assertRaises(lw.Interrupted):
            lw.solve(lw.read(CORNELL), **LONG, progress=lambda phase, share: False)

    def test_false_stops_every_long_call(self):
        def stop(phase, share):
            return False

        scene = lw.read(CORNELL)
        solution = lw.solve(scene, refine="off", gather_rays=16)
        points = [[0.2 + 1e-5 * k, 0.3, 0.2] for k in range(2000)]
        with self.assertRaises(lw.Interrupted):
            lw.form_factors(scene, max_patch_size=0.01, progress=stop)
        with self.assertRaises(lw.Interrupted):
            solution.render(width=2048, pass_="gather", quality="final", progress=stop)
        with self.assertRaises(lw.Interrupted):
            solution.probe(points, [0, 0, 1], rays=16384, progress=stop)
        with self.assertRaises(lw.Interrupted):
            solution.measure(points, [0, 0, 1], rays=16384, progress=stop)
        with self.assertRaises(lw.Interrupted):
            solution.report(surfaces=["floor"], rays=16384, spacing=0.01, progress=stop)

    def test_none_and_zero_go_on(self):
        lw.solve(lit_room(), refine="off", gather_rays=16, progress=lambda phase, share: 0)

    def test_exceptions_of_the_callback_come_back(self):
        def fail(phase, share):
            raise KeyError(phase)

        with self.assertRaises(KeyError):
            lw.solve(lw.read(CORNELL), **LONG, progress=fail)
        with self.assertRaises(TypeError):
            lw.solve(lw.read(CORNELL), **LONG, progress=lambda: None)
        # Nothing is left behind.
        self.assertEqual(lw.solve(lit_room(), refine="off", gather_rays=16).outcome, "converged")


class Threads(unittest.TestCase):
    def test_two_solves_at_once(self):
        scenes = [lit_room(), lw.read(CORNELL)]
        options = {"refine": "off", "gather_rays": 64}
        alone = [lw.solve(scene, **options).direct_irradiance.tobytes() for scene in scenes]
        together = [None] * 4

        def work(k):
            together[k] = lw.solve(scenes[k % 2], **options).direct_irradiance.tobytes()

        threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(together, alone * 2)

    def test_others_run_meanwhile(self):
        # The other thread stops the work: that needs Python's lock while the call is at work.
        is_running, stops = threading.Event(), threading.Event()

        def other():
            is_running.wait()
            stops.set()

        thread = threading.Thread(target=other)
        thread.start()

        def progress(phase, share):
            is_running.set()
            return not stops.is_set()

        with self.assertRaises(lw.Interrupted):
            lw.solve(lw.read(CORNELL), **LONG, progress=progress)
        thread.join()


DAEMON = """
import sys
import threading
import lightwell as lw

scene = lw.read(sys.argv[1])
is_working = threading.Event()

def work():
    lw.solve(
        scene, max_patch_size=0.004, gather_rays=4096, progress=lambda phase, share: is_working.set()
    )

threading.Thread(target=work, daemon=True).start()
is_working.wait()
print("the main thread ends", flush=True)
"""


class DaemonThreads(unittest.TestCase):
    def test_end_with_the_interpreter(self):
        done = subprocess.run(
            [sys.executable, "-c", DAEMON, CORNELL], capture_output=True, text=True, check=False
        )
        self.assertEqual((done.stdout, done.stderr), ("the main thread ends\n", ""))
        self.assertEqual(done.returncode, 0)


FORKED = """
import os
import sys
import threading
import lightwell as lw

scene = lw.read(sys.argv[1])
is_working = threading.Event()
stops = threading.Event()

def progress(phase, share):
    is_working.set()
    return not stops.is_set()

def work():
    try:
        lw.solve(scene, max_patch_size=0.004, gather_rays=4096, progress=progress)
    except lw.Interrupted:
        pass

thread = threading.Thread(target=work)
thread.start()
is_working.wait()
child = os.fork()
if child == 0:
    sys.exit(7)
_, status = os.waitpid(child, 0)
stops.set()
thread.join()
print(os.WEXITSTATUS(status), flush=True)
"""


class Forks(unittest.TestCase):
    @unittest.skipUnless(hasattr(os, "fork"), "this system has no fork")
    def test_end_though_another_thread_works(self):
        options = ["-W", "ignore::DeprecationWarning"]  # Python 3.12 warns of forks with threads
        child = subprocess.Popen(
            [sys.executable, *options, "-c", FORKED, CORNELL],
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        try:
            said, _ = child.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)  # the child's child too
            child.communicate()
            raise
        self.assertEqual(said, "7\n")


INTERRUPTED = """
import sys
import lightwell as lw

scene = lw.read(sys.argv[1])
started = []

def say_at_first(phase, share):
    if not started:
        started.append(phase)
        print("working", flush=True)

try:
    lw.solve(scene, max_patch_size=0.004, gather_rays=4096, progress=say_at_first)
    print("finished", flush=True)
except KeyboardInterrupt:
    print("interrupted", flush=True)
print(lw.solve(scene, refine="off", gather_rays=16).outcome, flush=True)
"""


class ControlC(unittest.TestCase):
    def test_raises_keyboard_interrupt(self):
        child = subprocess.Popen(
            [sys.executable, "-c", INTERRUPTED, CORNELL],
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ,
        )
        self.assertEqual(child.stdout.readline(), "working\n")
        child.send_signal(signal.SIGINT)
        said, _ = child.communicate()
        self.assertEqual(said, "interrupted\nconverged\n")
        self.assertEqual(child.returncode, 0)


if __name__ == "__main__":
    unittest.main()
