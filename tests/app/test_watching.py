import os

import pytest

from app.watching import changes


class Clock:
    """Does one thing to the files at each wait, so that no test waits."""

    def __init__(self, *steps):
        self.steps = list(steps)
        self.waits = 0

    def __call__(self, seconds):
        self.waits += 1
        step = self.steps.pop(0) if self.steps else None
        if step is Ellipsis:
            raise StopWaitingError
        if step is not None:
            step()


class StopWaitingError(Exception):
    pass


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "m.ply"
    path.write_bytes(b"one")
    return path


def test_the_first_comes_at_once_and_a_change_once_it_stands_still(file):
    clock = Clock(None, lambda: file.write_bytes(b"half"), lambda: file.write_bytes(b"whole"))
    watch = changes(lambda: [file], sleep=clock)
    assert next(watch) == ()
    assert clock.waits == 0
    assert next(watch) == (file,)
    # Nothing; a change; another while waiting for it to settle; the same twice.
    assert clock.waits == 4
    assert file.read_bytes() == b"whole"


def test_the_same_size_and_a_new_time_is_a_change(file):
    clock = Clock(lambda: os.utime(file, ns=(1, 1)))
    watch = changes(lambda: [file], sleep=clock)
    next(watch)
    assert next(watch) == (file,)


def test_going_and_coming_back_are_changes(file):
    watch = changes(
        lambda: [file], sleep=Clock(file.unlink, None, lambda: file.write_bytes(b"back"))
    )
    next(watch)
    assert next(watch) == (file,)
    assert not file.exists()
    assert next(watch) == (file,)
    assert file.exists()


def test_a_flicker_that_ends_as_it_began_is_no_change(file):
    found = file.stat()

    def back():
        file.write_bytes(b"one")
        os.utime(file, ns=(found.st_atime_ns, found.st_mtime_ns))

    watch = changes(lambda: [file], sleep=Clock(file.unlink, back, None, None, ...))
    next(watch)
    with pytest.raises(StopWaitingError):
        next(watch)


def test_a_change_while_the_caller_works_is_seen_afterwards(file):
    watch = changes(lambda: [file], sleep=Clock())
    next(watch)
    file.write_bytes(b"meanwhile")
    assert next(watch) == (file,)


def test_one_file_may_name_another(file, tmp_path):
    other = tmp_path / "other.ply"
    other.write_bytes(b"x")
    named = [file]
    watch = changes(
        lambda: list(named),
        sleep=Clock(
            lambda: (file.write_bytes(b"names other"), named.append(other)),
            None,
            lambda: other.write_bytes(b"changed"),
        ),
    )
    next(watch)
    assert next(watch) == (file,)
    assert next(watch) == (other,)


def test_watching_survives_bad_files_and_ends_at_an_interrupt(tmp_path, monkeypatch, capsys):
    import shutil

    from app import watching
    from app.cli.main import main
    from app.samples import sample

    mesh, saved, out = (tmp_path / name for name in ("m.ply", "s.json", "x.png"))
    shutil.copy(sample("torus").path, mesh)
    good = '{"mesh": "m.ply", "size": [64, 48], "estimator": {"name": "rusinkiewicz2004"}%s}'
    saved.write_text(good % "")
    pictures = []

    def see(change):
        """Change a file after noting what the change before has made."""

        def step():
            pictures.append(out.read_bytes())
            change()

        return step

    def stop():
        raise KeyboardInterrupt

    whole = mesh.read_bytes()
    clock = Clock(
        *(see(lambda: mesh.write_bytes(whole[:4000])), None),
        *(see(mesh.unlink), None),
        *(see(lambda: saved.write_text('{"mesh": "m.p')), None),
        *(see(lambda: saved.write_text(good % ', "material": "granite"')), None),
        *(see(lambda: mesh.write_bytes(whole)), None),
        *(see(lambda: saved.write_text(good % ', "material": "marble"')), None),
        see(stop),
    )
    monkeypatch.setattr(watching.changes, "__defaults__", (0.5, clock))
    assert main(["shade", "--session", str(saved), "-o", str(out), "--watch"]) == 0
    told = capsys.readouterr().err
    for words in (
        "the file is damaged",
        "there is no such file",
        "not a Curvelight session",
        "unknown material 'granite'",
        "stopped watching",
    ):
        assert words in told
    assert told.count("waiting for it to change") >= 4
    # Nothing touches the picture until all is well again.
    assert len(pictures) == 7
    assert len(set(pictures[:6])) == 1
    assert pictures[6] != pictures[0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["sample:torus", "-o", "x.png"], "nothing to watch"),
        (["m.ply", "-o", "x.png", "--json"], "--watch has no end"),
        (["m.ply", "-o", "x.png", "--camera", "behind"], "behind"),
    ],
)
def test_what_was_typed_wrong_is_not_waited_for(arguments, words, tmp_path, monkeypatch, capsys):
    from app.cli.main import main

    monkeypatch.chdir(tmp_path)
    assert main(["shade", *arguments, "--watch"]) == 2
    assert words in capsys.readouterr().err


def test_print_config_prints_what_flags_make_of_a_file(tmp_path, capsys):
    from app.cli.main import main
    from app.session import from_json

    saved = tmp_path / "s.json"
    saved.write_text('{"mesh": "sample:torus", "material": "marble", "size": [64, 48]}')
    arguments = ["--session", str(saved), "--size", "80x60", "--print-config"]
    for command in ("shade", "curvature", "figure"):
        assert main([command, *arguments]) == 0
        session = from_json(capsys.readouterr().out.encode())
        assert (session.material, session.size, session.view) == ("marble", (80, 60), command)
    assert main(["compare", *arguments, "--models", "wrap,lambert"]) == 0
    assert len(from_json(capsys.readouterr().out.encode()).compared) == 2
    assert list(tmp_path.iterdir()) == [saved]
    assert main(["shade", "--session", str(saved)]) == 2  # drawing does need an output
