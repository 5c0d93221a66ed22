import json
import subprocess
import sys

import pytest

from app.loading import load_mesh
from tests.corrupt import damaged, truncated
from tests.mesh_files import one_of_each

FILES = one_of_each()
# Each VTP costs the start of a child process with VTK in it, about .4 s.
FLIPS = {"plain.vtp": 8}


def load_all(folder):
    done = subprocess.run(
        [sys.executable, "-m", "tests.load_all", str(folder)],
        capture_output=True,
        timeout=240,
        check=False,
    )
    assert done.returncode == 0, done.stderr.decode()[-2000:]
    # Readers report by exceptions and warnings of ours, never on the terminal.
    assert (done.stdout, done.stderr) == (b"", b"")
    return json.loads((folder / "answer.json").read_text())


@pytest.mark.parametrize("name", FILES)
def test_damaged_files_give_a_sound_mesh_or_a_clear_refusal(tmp_path, name):
    for index, content in enumerate(damaged(FILES[name], FLIPS.get(name, 30))):
        (tmp_path / f"{index:03}.{name.split('.')[1]}").write_bytes(content)
    answer = load_all(tmp_path)
    assert len(answer) > 20
    wrong = {each: outcome for each, (outcome, _) in answer.items()}
    assert {each: out for each, out in wrong.items() if out not in ("mesh", "refused")} == {}
    # The damage must reach the readers' checks, and the checks must bite.
    assert "refused" in wrong.values()
    # Files of 2 kB: anything beyond VTK's start-up on a busy machine is a loop over a false count.
    assert max(seconds for _, seconds in answer.values()) < 20


# OBJ neither counts nor ends its lists: a cut between two lines cannot be told from the end.
@pytest.mark.parametrize("name", [name for name in FILES if name != "plain.obj"])
def test_a_file_cut_short_is_never_taken_for_whole(tmp_path, name):
    content = FILES[name]
    if b"\0" not in content:
        # A text that lost digits of its last number, or the name after "endsolid", looks whole.
        content = content.rsplit(maxsplit=3)[0]
    for index, part in enumerate(truncated(content)):
        (tmp_path / f"{index:03}.{name.split('.')[1]}").write_bytes(part)
    answer = load_all(tmp_path)
    assert {outcome for outcome, _ in answer.values()} == {"refused"}


@pytest.mark.parametrize("name", ["text.ply", "plain.off", "plain.obj"])
def test_a_text_that_may_have_lost_digits_is_reported(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(FILES[name].rstrip()[:-1])
    assert "last number" in load_mesh(path).warnings[0]
