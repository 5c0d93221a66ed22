"""That the bench of corrupted files counts what it says, on answers made by hand."""

from tests.bench import robustness
from tests.corpus.cases import Case


def test_outcomes_are_counted_and_valid_files_tell_which_formats_a_reader_knows():
    cases = [Case(f"{n}.x", b"", seed, "cut") for n, seed in enumerate(("a", "a", "b"))]
    valid = [{"outcome": "mesh"}, {"outcome": "refused"}]
    rest = [
        {"outcome": "refused", "seconds": 1.0, "peak_mib": 5.0, "code": 3},
        {"outcome": "died", "seconds": 2.0, "said": "11"},
        {"outcome": "empty", "seconds": 0.5, "peak_mib": 9.0},
    ]
    row = robustness._summary([*valid, *rest], ["a", "b"], cases)
    assert (row["formats"], row["files of formats it reads"]) == (1, 2)
    assert (row["refused"], row["died"], row["empty"], row["hung"]) == (1, 1, 1, 0)
    assert (row["slowest_s"], row["peak_mib"], row["codes"]) == (2.0, 9.0, {"3": 1})
    assert row["wrong"] == ["1.x: died 11"]


def test_every_reader_reads_a_valid_file_and_none_takes_a_bad_index_for_fine(tmp_path):
    from tests.mesh_files import grid, ply

    vertices, faces = grid()
    (tmp_path / "good.ply").write_bytes(ply(vertices, faces, None, ""))
    for reader in robustness.READERS:
        server = robustness.Server(reader)
        assert server.read(tmp_path / "good.ply")["outcome"] == "mesh", reader
        assert server.read(tmp_path / "none.ply")["outcome"] == "refused", reader
        server.stop()
