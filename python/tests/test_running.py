# SPDX-License-Identifier: MIT
"""Threads, interruption, cancelling, processes and memory."""
import gc
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import merlin

QUICK = {"size": 64, "views": 1}


def test_what_progress_raises_ends_the_work(quick, photo):
    """And comes out."""
    def fail(_stage, _share):
        raise KeyError("mine")
    with pytest.raises(KeyError, match="mine"):
        quick(*photo, progress=fail)


def test_stop_ends_the_work(quick, photo):
    """By its answer, by what it raises, or by another thread's event."""
    with pytest.raises(merlin.StoppedError, match="stopped"):
        quick(*photo, stop=lambda: True)
    with pytest.raises(ZeroDivisionError):
        quick(*photo, stop=lambda: 1 / 0)
    event = threading.Event()
    asked = []
    def stop():
        asked.append(1)
        return event.is_set()
    quick(*photo, stop=stop)
    event.set()
    with pytest.raises(merlin.StoppedError):
        quick(*photo, stop=stop)
    assert len(asked) > 2


def test_control_c_ends_the_work_and_the_next_one_runs(quick, photo):
    """KeyboardInterrupt, and the handler is back."""
    def press(_stage, _share):
        os.kill(os.getpid(), signal.SIGINT)
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        quick(*photo, progress=press)
    assert signal.getsignal(signal.SIGINT) is before
    assert quick(*photo).albedo.mean() > 0


def test_other_threads_run_meanwhile(quick, photo):
    """The interpreter's lock is let go of."""
    counted = [0]
    done = threading.Event()
    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)
    thread = threading.Thread(target=count)
    thread.start()
    quick(*photo, size=128)
    done.set()
    thread.join()
    assert counted[0] > 10


def test_two_threads_with_models_of_their_own_run(photo, kept_maps):
    """To the same maps, beside two that share one."""
    color, mask = photo
    results = {}
    def work(name, model):
        results[name] = [model.estimate(color, mask, **QUICK).normal for _ in range(2)]
    shared = merlin.Model("merlin-any")
    models = {"own": merlin.Model("merlin-any"), "shared 1": shared, "shared 2": shared}
    import warnings
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        threads = [threading.Thread(target=work, args=item, daemon=True) for item in models.items()]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(60)
    assert not any(thread.is_alive() for thread in threads)
    for normals in results.values():
        for normal in normals:
            np.testing.assert_allclose(normal, kept_maps.normal, atol=1e-4)
    assert len(results) == 3


def test_a_model_closed_by_another_thread_ends_after_its_calls(photo):
    """Never beneath them."""
    model = merlin.Model("merlin-any")
    maps = []
    thread = threading.Thread(target=lambda: maps.append(model.estimate(*photo, **QUICK)))
    import warnings
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        thread.start()
        time.sleep(0.05)
        model.close()
        thread.join()
    assert len(maps) == 1 or pytest.skip("it was closed before the call began")


def run(source, code, **environment):
    """A Python of its own."""
    env = {**os.environ, "PYTHONPATH": os.path.join(source, "python"), **environment}
    return subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, env=env,
                          timeout=60, check=False)


def test_a_forked_child_is_told_not_to_call(source, demo):
    """Instead of waiting for ever."""
    done = run(source, f"""
        import merlin, os
        merlin.read_image({demo!r})
        child = os.fork()
        if child == 0:
            try:
                merlin.read_image({demo!r})
            except RuntimeError as error:
                print(error, flush=True)
            os._exit(0)
        os.waitpid(child, 0)""")
    assert "spawn" in done.stdout, done


def test_a_missing_library_is_one_import_error(source, tmp_path):
    """That says what to do."""
    for name, content in (("none.so", None), ("words.so", "words")):
        path = tmp_path / name
        if content:
            path.write_text(content)
        done = run(source, "import merlin", MERLIN_LIBRARY=str(path))
        last = done.stderr.strip().splitlines()[-1]
        assert last.startswith("ImportError: ") and name in last, done.stderr


def test_the_library_of_the_processors_level_is_taken(tmp_path, monkeypatch):
    """The best that there is and that can run."""
    from merlin import _library
    for level in ("", "x86-64-v3", "x86-64-v4"):
        (tmp_path / "lib" / level).mkdir(parents=True, exist_ok=True)
        (tmp_path / "lib" / level / "libmerlin.so").touch()
    monkeypatch.setattr(_library, "HERE", str(tmp_path))
    monkeypatch.delenv("MERLIN_LIBRARY", raising=False)
    wide = _library._LEVELS["x86-64-v4"]
    for flags, level in ((wide | {"amx_tile"}, "x86-64-v4"), (wide - {"avx512vl"}, "x86-64-v3"), ({"sse2"}, "")):
        monkeypatch.setattr(_library, "_processor_flags", lambda flags=flags: flags)
        assert _library._candidates()[0] == os.path.join(tmp_path, "lib", level, "libmerlin.so")
    (tmp_path / "lib" / "libmerlin.so").unlink()
    assert _library._candidates()[-1] == "libmerlin.so.0.1"


def resident_kib():
    """Of this process, now."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE") // 1024


def grows(work, rounds, warm=5):
    """KiB by which memory grows over so many rounds."""
    for _ in range(warm):
        work()
    gc.collect()
    before = resident_kib()
    for _ in range(rounds):
        work()
    gc.collect()
    return resident_kib() - before


def test_estimates_hold_memory_flat(quick, photo):
    """tools/measure-python counts a hundred large ones; a leak of one map here would be 3 MB."""
    assert grows(lambda: quick(*photo).relight((0, 0, 0), by="direct"), 12) < 2048


def test_refusals_hold_memory_flat(quick, photo):
    """Of every stage."""
    color, mask = photo
    large = np.full((512, 512, 3), np.nan, np.float32)
    def refuse():
        for arguments, options in (((large,), {}), ((color, mask[1:]), {}), ((color, mask), {"views": 99}),
                                   ((color, mask), {"stop": lambda: True}), (("nowhere.png",), {})):
            with pytest.raises(merlin.MerlinError):
                quick(*arguments, **options)
    assert grows(refuse, 12) < 2048
