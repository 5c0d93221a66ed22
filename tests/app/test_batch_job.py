"""What a job says: names, order of precedence, messages. Nothing is drawn."""

import argparse
from textwrap import dedent

import msgspec
import pytest

from app.batch.job_file import JobError, read
from app.batch.plan import planned
from app.batch.template import filled
from app.cli import batch, compare, curvature, figure, shade
from app.cli.batch import _EXAMPLE
from app.cli.batch_job import job_from
from app.cli.main import main
from app.cli.options.mesh import add_mesh
from app.cli.performing import add_performing
from app.session import Method, Session, Volume, write
from lutcore.errors import ParameterError

VALUES = {"stem": "bust", "n": 7, "model": "lambert", "material": "skin1", "output": "shade"}


def job_of(folder, text):
    path = folder / "job.toml"
    path.write_text(text)
    return read(path)


def works_of(folder, text, overrides=None):
    items, _ = planned(job_of(folder, text), overrides or {})
    return {work.file: work for item in items for work in item.works}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "scans").mkdir()
    for name in ("scans/a.ply", "scans/b_cm.ply", "c.ply"):
        (tmp_path / name).write_bytes(b"")
    return tmp_path


def test_templates_name_results():
    assert filled("{stem}/{model}-{n:3}", VALUES) == "bust/lambert-007"
    assert filled("{n}{n:1}", VALUES) == "77"
    assert filled("{stem}", VALUES | {"stem": "a:b?c/d"}) == "a_b_c_d"


@pytest.mark.parametrize(
    ("template", "says"),
    [
        ("{steam}", "did you mean 'stem'"),
        ("{stem:3}", "digits are counted for n only"),
        ("{stem", "brace"),
        ("../{stem}", "inside the output folder"),
        ("/{stem}", "inside the output folder"),
        (".{stem}", "inside the output folder"),
        ("", "inside the output folder"),
        ("{n:999}", "up to 12"),
    ],
)
def test_bad_templates_are_refused(template, says):
    with pytest.raises(ParameterError, match=says):
        filled(template, VALUES)


def test_later_parts_of_a_job_stand_above_earlier_ones(folder):
    write(Session(material="marble", exposure=3.0), folder / "hero.json")
    works = works_of(
        folder,
        """
        meshes = ["scans/*.ply", "sample:torus"]
        outputs = ["shade"]
        [defaults]
        size = [300, 200]
        exposure = 2.0
        [[sessions]]
        name = "plain"
        [[sessions]]
        name = "hero"
        file = "hero.json"
        material = "skin2"
        [[blocks]]
        match = "*_cm.ply"
        mm_per_unit = 10.0
        exposure = 5.0
        [[blocks]]
        match = ["scans/b*", "nothing"]
        exposure = 6.0
        """,
    )
    assert len(works) == 6
    plain, hero = works["a-plain-shade.png"].session, works["a-hero-shade.png"].session
    assert (plain.material, plain.exposure, plain.size) == ("skin1", 2.0, (300, 200))
    # A session file that says all its fields says its size too.
    assert (hero.material, hero.exposure, hero.size) == ("skin2", 3.0, (1000, 1000))
    large = works["b_cm-plain-shade.png"].session
    assert (large.mm_per_unit, large.exposure) == (10.0, 6.0)
    assert works["torus-plain-shade.png"].session.mesh == "sample:torus"
    assert plain.mesh == str(folder / "scans" / "a.ply")


def test_the_job_of_the_help_text_is_one(folder):
    text = _EXAMPLE.partition("a job file:\n")[2].partition("\n--resume")[0]
    write(Session(exposure=3.0), folder / "hero.session.json")
    works = works_of(folder, dedent(text))
    assert set(works) == {
        *(
            f"{stem}/{session}-{name}"
            for stem in ("a", "torus")
            for session in ("plain", "marble")
            for name in ("shade.png", "curvature.png", "report.html")
        ),
        "b_cm/plain-compare.png",
        "b_cm/marble-compare.png",
    }
    assert works["b_cm/marble-compare.png"].session.mm_per_unit == 10.0


def test_flags_stand_above_the_job(folder):
    text = 'meshes = "c.ply"\noutputs = ["shade"]\n[[blocks]]\nmatch = "*"\nexposure = 5.0\n'
    assert works_of(folder, text, {"exposure": 7.0})["c-shade.png"].session.exposure == 7.0


def said_by_flags(*words):
    parser = argparse.ArgumentParser()
    batch.add_arguments(parser, list(words))
    return job_from(parser.parse_args([*words, "-o", "out"]))


def flags_of(add, *arguments):
    parser = argparse.ArgumentParser()
    add(parser, *arguments)
    return {flag for action in parser._actions for flag in action.option_strings}


def test_a_batch_has_the_flags_of_the_commands_that_it_runs():
    shared = {"-h", "--help", "-o", "--output"}
    own = flags_of(batch.add_arguments, [])
    for command in (shade, curvature, compare, figure):
        # What makes a picture; not where it goes, whether it moves, or what it is compared with.
        makes = flags_of(command.add_arguments, [])
        about_one = flags_of(add_mesh) | flags_of(add_performing, argparse.Action([], "output"))
        missing = makes - own - about_one - shared
        assert not missing, command
    assert {"--level", "--smoothing", "--by", "--wipe", "--repair"} <= own


def test_comparisons_and_volumes_are_said_by_flags(folder):
    job, overrides = said_by_flags(
        str(folder / "c.ply"),
        *("--outputs", "compare", "--models", "skin1,marble", "--by", "material"),
        *("--wipe", ".3", "--difference", "--level", "7.5", "--smoothing", "2"),
    )
    ((work,),) = (item.works for item in planned(job, overrides)[0])
    assert work.session.compared == (Method("skin1"), Method("marble"))
    assert (work.session.compared_by, work.session.wipe) == ("material", 0.3)
    assert work.session.difference and work.session.volume == Volume(7.5, 2.0)
    with pytest.raises(ParameterError, match="wipe"):
        said_by_flags(str(folder / "c.ply"), "--wipe", "3")


def test_a_flag_that_says_the_default_stands_above_the_job_too(folder):
    path = folder / "job.toml"
    path.write_text(
        'meshes = "c.ply"\noutputs = ["shade"]\n[defaults]\nmaterial = "marble"\nscale = 2.0\n'
        'shadows = "on"\nmodel.name = "lambert"\n[defaults.volume]\nlevel = 3.0\n'
    )
    plain = planned(*said_by_flags(str(path)))[0][0].works[0].session
    assert (plain.material, plain.scale, plain.shadows) == ("marble", 2.0, "on")
    words = ("--material", "skin1", "--scale", "auto", "--shadows", "off", "--level", "otsu")
    flagged = planned(*said_by_flags(str(path), *words, "--model", "curvature-lut"))[0][0]
    session = flagged.works[0].session
    assert (session.material, session.scale, session.shadows) == ("skin1", None, "off")
    assert (session.model, session.volume.level) == (Method("curvature-lut"), None)


def test_blocks_choose_outputs_and_limits(folder):
    text = """
    meshes = ["scans/*", "c.ply"]
    seconds = 9
    [[blocks]]
    match = "c.ply"
    outputs = ["report", "curvature"]
    seconds = 2.5
    memory_gib = 1
    """
    items, remarks = planned(job_of(folder, text), {})
    assert remarks == []
    assert [item.seconds for item in items] == [9.0, 9.0, 2.5]
    assert [item.memory_gib for item in items] == [4.0, 4.0, 1.0]
    report, curvature = items[2].works
    assert report.files == ("c-report.html", "c-report.session.json")
    assert (report.session.quantity, curvature.session.quantity) == ("all", "curvedness")


def test_a_block_without_a_mesh_is_remarked(folder):
    text = 'meshes = "c.ply"\n[[blocks]]\nmatch = "*.stl"\nflat = true\n'
    _, remarks = planned(job_of(folder, text), {})
    assert len(remarks) == 1
    assert "[[blocks]] 1 matches no mesh (*.stl)" in remarks[0]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("meshes = ", "not TOML"),
        ("", "missing required field `meshes`"),
        ('meshes = "c.ply"\nmesh = 1', "unknown field `mesh`"),
        ('meshes = "c.ply"\noutputs = ["shades"]', r"\$.outputs"),
        ('meshes = "c.ply"\nseconds = 0', r"\$.seconds"),
        ('meshes = "c.ply"\n[defaults]\nmateral = "x"', "did you mean 'material'"),
        ('meshes = "c.ply"\n[defaults]\nsize = [1, 2]', r"\[defaults\].*\$.size"),
        ('meshes = "c.ply"\n[defaults]\nmodel.nam = "x"', r"\$.model"),
        ('meshes = "c.ply"\n[defaults]\nview = "shade"', "decided by the job"),
        ('meshes = "c.ply"\n[defaults]\nrange = [2.0, 1.0]', "first must be below"),
        ('meshes = "c.ply"\n[[blocks]]\nflat = true', r"\[\[blocks\]\] 1.*match"),
        ('meshes = "c.ply"\n[[sessions]]\nflat = true', r"\[\[sessions\]\] 1.*name"),
        ('meshes = "c.ply"\n[[sessions]]\nname = "a"\n[[sessions]]\nname = "a"', "one name"),
    ],
)
def test_what_a_job_cannot_say_is_told_with_its_place(folder, text, says):
    with pytest.raises(JobError, match=says) as caught:
        job_of(folder, text)
    assert str(caught.value).startswith(str(folder / "job.toml"))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('meshes = "*.stl"', "matches no file"),
        ('meshes = "c.ply"\noutputs = ["compare"]', "two models"),
        ('meshes = "c.ply"\n[defaults]\nmaterial = "marbel"', "did you mean 'marble'"),
        ('meshes = "c.ply"\n[defaults]\nmodel.name = "lambart"', "did you mean 'lambert'"),
        ('meshes = "c.ply"\n[defaults]\ncamera = "fornt"', "did you mean 'front'"),
        ('meshes = "c.ply"\ntemplate = "x"\noutputs = ["shade", "figure"]', "gives 'x.png' to"),
        ('meshes = "c.ply"\ntemplate = "CONTACT"', "the batch itself"),
        ('meshes = ["c.ply", "scans/*"]\ntemplate = "{material}"', "add"),
        ('meshes = "c.ply"\n[defaults]\nquantity = "all"', "one quantity"),
    ],
)
def test_what_cannot_be_done_is_told_before_any_work(folder, text, says):
    with pytest.raises(ParameterError, match=says):
        planned(job_of(folder, text), {})


def test_an_item_survives_its_way_to_a_worker(folder):
    (item,), _ = planned(job_of(folder, 'meshes = "c.ply"\noutputs = ["shade", "report"]'), {})
    assert msgspec.json.decode(msgspec.json.encode(item), type=type(item)) == item


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        (["job.toml"], 3, "cannot be read"),
        (["job.toml", "a.ply"], 2, "name it alone"),
        (["sample:torus", "--jobs", "0"], 2, "at least one"),
        (["sample:torus", "--dask", "tcp://x", "--jobs", "2"], 2, "cluster"),
        (["sample:torus", "--outputs", "shad"], 2, "did you mean 'shade'"),
        (["sample:torus", "--seconds", "-1"], 2, "not above 0"),
    ],
)
def test_wrong_arguments_end_before_any_work(words, code, says, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["batch", *words, "-o", "out"]) == code
    assert says in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_an_address_without_a_scheduler_is_told(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("app.batch.cluster._PATIENCE", 0.2)
    words = ["batch", "sample:torus", "--dask", "tcp://127.0.0.1:1", "-o", str(tmp_path / "out")]
    assert main(words) == 1
    assert "no Dask scheduler answers" in capsys.readouterr().err
