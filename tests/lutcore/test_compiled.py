import os
import subprocess
import sys

import numba

from lutcore import cache, compiled
from lutcore.compiled import cache_folder


def test_the_cache_goes_where_it_is_told(tmp_path, monkeypatch):
    monkeypatch.setenv("CURVELIGHT_CACHE_DIR", str(tmp_path / "here"))
    assert cache_folder().is_relative_to(tmp_path / "here")


def test_a_cache_that_cannot_be_written_goes_to_the_temporary_folder(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("CURVELIGHT_CACHE_DIR", str(tmp_path / "file" / "below"))
    monkeypatch.setattr(cache.tempfile, "gettempdir", lambda: str(tmp_path))
    folder = cache_folder()
    assert folder.is_dir()
    assert folder.is_relative_to(tmp_path)


def test_old_caches_are_removed_and_recent_ones_kept(tmp_path, monkeypatch):
    monkeypatch.setenv("CURVELIGHT_CACHE_DIR", str(tmp_path))
    old, recent = tmp_path / "compiled" / "old", tmp_path / "compiled" / "recent"
    old.mkdir(parents=True)
    recent.mkdir()
    cache.os.utime(old, (0.0, 0.0))
    cache_folder()
    assert not old.exists()
    assert recent.exists()


def test_compiling_leaves_numbas_own_setting_alone():
    before = numba.config.CACHE_DIR
    compiled.compiled()(lambda x: x)
    assert before == numba.config.CACHE_DIR


def test_importing_the_library_compiles_and_imports_nothing_heavy():
    code = "import sys, lutcore; print('numba' in sys.modules, 'numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False False"


def test_a_full_disk_keeps_no_code_and_hinders_no_result(tmp_path):
    code = (
        "import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
        "import lutcore.color, numpy;"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100));"
        "print(lutcore.color.srgb_encode(numpy.ones(1))[0] > 0.999)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "CURVELIGHT_CACHE_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout.strip() == "True", done.stderr


def test_the_user_is_told_once_when_something_has_to_be_compiled(tmp_path):
    code = (
        "import lutcore.color, numpy;"
        "from lutcore.compiling import when_compiling;"
        "when_compiling(lambda: print('compiling'));"
        "[lutcore.color.srgb_encode(numpy.ones(shape)) for shape in (1, (1, 3))]"
    )
    said = [
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "CURVELIGHT_CACHE_DIR": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        for _ in range(2)
    ]
    assert said == [["compiling"], []]


_ELSEWHERE = (
    "import sys, lutcore.topology, numpy;"
    "from lutcore.compiling import compile_elsewhere;"
    "compile_elsewhere();"
    "rows = numpy.array([[0, 2], [1, 2]]);"
    "found = [lutcore.topology.components(rows.astype(t), 4)[0] for t in (numpy.int32, 'i8')];"
    "print(*found, 'numba.np.arraymath' in sys.modules)"
)


def test_a_child_compiles_where_it_is_asked_for_and_keeps_it_for_all(tmp_path):
    environment = {**os.environ, "CURVELIGHT_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-c", _ELSEWHERE]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["2", "2", "False"]
    assert list(tmp_path.rglob("joining.*.nbc"))


def test_what_a_child_cannot_keep_is_compiled_here(tmp_path):
    full = "import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
    full += "resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100));"
    environment = {**os.environ, "CURVELIGHT_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-c", full + _ELSEWHERE]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["2", "2", "True"]


def test_kept_code_is_loaded_without_what_compiles_and_more_can_be_compiled_after(tmp_path):
    code = (
        "import sys, lutcore.topology, numpy;"
        "rows = numpy.array([[0, 2], [1, 2]]);"
        "found = [lutcore.topology.components(rows, 4)[0]];"
        "compilers = 'numba.np.arraymath', 'scipy.linalg';"
        "print(any(name in sys.modules for name in compilers));"
        "kinds = numpy.int16, numpy.int8;"
        "found += [lutcore.topology.components(rows.astype(kind), 4)[0] for kind in kinds];"
        "print(*found)"
    )
    said = [
        subprocess.run(
            [sys.executable, "-c", code.replace("int8", kind)],
            env={**os.environ, "CURVELIGHT_CACHE_DIR": str(tmp_path)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        for kind in ("int16", "int8")
    ]
    assert said == [["True", *"222"], ["False", *"222"]]
