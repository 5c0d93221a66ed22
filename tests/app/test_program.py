import subprocess
import sys

PROGRAM = "import sys; from app.cli.program import program; sys.exit(program())"


def run(*words, before=""):
    return subprocess.run(
        [sys.executable, "-c", f"{before}\n{PROGRAM}", *words],
        capture_output=True,
        text=True,
        check=False,
    )


def test_it_answers_and_ends_as_the_command_line_does():
    done = run("materials")
    assert done.returncode == 0
    assert "skin1" in done.stdout
    refused = run("shade", "nowhere.ply", "-o", "out.png")
    assert refused.returncode == 3
    assert "nowhere.ply" in refused.stderr
    assert run("no-such-command").returncode == 2


def test_what_is_to_be_done_at_the_end_is_done_and_nothing_after_it():
    before = """
import atexit, weakref
import app.cli.main as module
whole = module.main
class Thing:
    def __del__(self):
        print("taken apart")
kept = Thing()
def main():
    code = whole()
    atexit.register(lambda: print("at the end", end=""))  # and not flushed
    return code
module.main = main
"""
    done = run("materials", before=before)
    assert done.returncode == 0
    assert done.stdout.endswith("at the end")


def test_a_reader_that_leaves_is_no_fault():
    command = f'"{sys.executable}" -c "{PROGRAM}" models | head -1'
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=True)
    assert done.stdout.count("\n") == 1
    assert not done.stderr
