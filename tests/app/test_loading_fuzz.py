import pytest

from app.loading.errors import UnreadableFileError
from tests.corpus.cases import seed_files
from tests.fuzz import search as search_module
from tests.fuzz.lines import Lines
from tests.fuzz.search import Search

FILES = seed_files(children=False)


def test_a_short_search_finds_nothing_and_gets_further_than_its_seeds(tmp_path):
    search = Search(FILES, 0, tmp_path)
    reached = len(search.lines.seen)
    for _ in range(1000):
        search.step()
    assert search.faults == []
    # Lines that no valid file reaches: refusals above all, of which there are a hundred.
    assert len(search.lines.seen) > reached + 100
    assert len(search.kept) > len(FILES) + 20


@pytest.mark.parametrize("fault", [ValueError("odd"), MemoryError(), UnreadableFileError("odd")])
def test_a_fault_would_be_found(tmp_path, monkeypatch, fault):
    search = Search({"plain.obj": FILES["plain.obj"]}, 0, tmp_path)
    assert search.faults == []

    def broken(path):
        raise fault

    monkeypatch.setattr(search_module, "load_mesh", broken)
    search.step()
    assert len(search.faults) == 1
    assert (tmp_path / "plain.obj").read_bytes() == search.faults[0][1]


def test_a_loop_without_end_would_be_found(tmp_path, monkeypatch):
    search = Search({"plain.obj": FILES["plain.obj"]}, 0, tmp_path)

    def endless(path):
        while True:
            pass

    monkeypatch.setattr(search_module, "load_mesh", endless)
    monkeypatch.setattr(search_module, "_SECONDS", 0.2)
    search.step()
    assert "more than 0.2 s" in search.faults[0][2]


def test_lines_are_those_of_the_readers_alone(tmp_path):
    from app.loading.text import numbers

    lines = Lines()
    assert lines.new_by(lambda: None) == 0
    assert lines.new_by(lambda: numbers(b"1 2")) > 3
    assert lines.new_by(lambda: numbers(b"3 4")) == 0
    assert lines.new_by(lambda: numbers(b"")) > 0
