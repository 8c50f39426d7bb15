"""The score curve, figures and films of a history."""

import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from PIL import Image

from meshwright.document import score_series
from meshwright.document.document import Document
from meshwright.document.score_series import ScoreSeries
from meshwright.graphics.drawing import Area, Drawing, Segments, hatching, raster, svg
from meshwright.graphics.export import export_job, video
from meshwright.graphics.export.export_job import ExportOptions
from meshwright.graphics.export.film import Film
from meshwright.graphics.mesh_figure import FigureOptions, edges, figure, summary
from meshwright.graphics.theme import THEMES
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.geometry import smoothing

SMALL = FigureOptions(size=(320, 240))


@pytest.fixture
def walked(star, greedy) -> Document:
    """The star after three bad steps and some good ones, two of them undone."""
    document = Document(star, "star")
    runner = greedy(star, bad_steps=3, longest=9)
    while not runner.finished:
        for operation, halfedge in runner.step():
            document.submit(operation, halfedge, by="greedy")
    document.smooth()
    document.go_to(len(document.history) - 2)
    return document


def test_score_track_follows_edits_undo_and_branches(walked):
    history, track = walked.history, ScoreSeries()

    def expected():
        first = history.first
        rows = [(row.after, row.optimum) for row in history]
        return [first, *rows]

    assert track.follow(history) == 0
    assert list(zip(track.scores.tolist(), track.optima.tolist(), strict=True)) == expected()
    assert track.follow(history) == len(history) + 1  # nothing is new
    walked.go_to(3)
    walked.smooth()
    assert len(walked.history.branches) == 1
    track.follow(history)
    assert list(zip(track.scores.tolist(), track.optima.tolist(), strict=True)) == expected()
    walked.take_branch(0)
    track.follow(history)
    assert list(zip(track.scores.tolist(), track.optima.tolist(), strict=True)) == expected()
    for _ in range(3):
        walked.set_desired(0, int(walked.mesh.desired()[0]) + 1)
        track.follow(history)
    assert list(zip(track.scores.tolist(), track.optima.tolist(), strict=True)) == expected()


def test_curve_has_a_bounded_number_of_points_per_pixel():
    rng = np.random.default_rng(2)
    scores = 40 + rng.integers(-1, 2, 10_000).cumsum()
    scores -= scores.min()
    box = score_series.frame(scores, np.zeros_like(scores), 10, 5, 600, 50)
    line = score_series.steps(scores, box)
    assert len(line) <= 4 * 601
    assert line[:, 1].min() == pytest.approx(5.0)
    assert line[:, 1].max() == pytest.approx(55.0)
    assert (np.diff(line[:, 0]) >= 0).all()
    assert [box.state(x) for x in (-5, 10, 310, 610, 900)] == [0, 0, 5000, 9999, 9999]
    few = np.array([5, 4, 6, 2, 3])
    line = score_series.steps(few, score_series.frame(few, few * 0, 0, 0, 100, 10))
    assert line[:, 0].tolist() == [0, 25, 25, 50, 50, 75, 75, 100, 100]
    level = np.full(1000, 7)
    assert len(score_series.steps(level, score_series.frame(level, level, 0, 0, 100, 10))) == 2


def test_far_optimum_does_not_flatten_the_curve():
    scores, optima = np.array([3336, 3340, 3330]), np.full(3, 20)
    box = score_series.frame(scores, optima, 0, 0, 100, 60)
    assert box.broken
    assert float(np.ptp(box.y(scores))) > 30
    assert box.y(20) == 60.0
    assert len(score_series.break_mark(box)) == 2
    assert not score_series.frame(np.array([40, 12]), np.array([4, 4]), 0, 0, 100, 60).broken


def test_the_best_state_counts_from_the_last_change_of_the_task():
    assert score_series.best_state(np.array([9, 5, 7, 5]), np.array([2, 2, 2, 2])) == 1
    assert score_series.best_state(np.array([9, 5, 7, 6]), np.array([2, 2, 3, 3])) == 3
    assert score_series.best_state(np.array([4]), np.array([2])) == 0


@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_every_edge_is_drawn_once(kind, star, triangles):
    mesh = star if kind == "quad" else triangles
    mesh.apply("collapse", next(h for h in range(mesh.k * 20) if mesh.check("collapse", h)))
    pairs = edges(mesh)
    assert len(pairs) == mesh.n_edges
    wanted = {
        frozenset(pair)
        for row in mesh.elements()
        for pair in zip(row, np.roll(row, 1), strict=True)
    }
    assert {frozenset(pair) for pair in pairs.tolist()} == {
        frozenset(map(int, pair)) for pair in wanted
    }


def test_film_is_exact_and_does_not_change_the_document(walked):
    cursor, mesh = walked.history.cursor, walked.mesh
    points, elements = mesh.points.copy(), mesh.elements()
    film = Film(walked)
    assert film.state == cursor
    states = {}
    for state in (*range(len(film)), *reversed(range(len(film)))):
        film.go_to(state)
        assert film.mesh.score == film.scores[state]
        seen = film.mesh.points.tobytes() + film.mesh.elements().tobytes()
        assert states.setdefault(state, seen) == seen
    film.mesh.validate()
    assert walked.history.cursor == cursor
    assert np.array_equal(mesh.points, points)
    assert np.array_equal(mesh.elements(), elements)
    film.go_to(cursor)
    assert np.array_equal(film.mesh.points, points)


def test_moment_has_the_edges_that_its_step_changed(walked):
    film = Film(walked)
    for state in range(1, len(film)):
        row, moment = film.rows[state - 1], film.moment(state)
        if row.action.startswith("flip"):
            assert len(moment.added) == len(moment.removed) == 1
        if row.action == "smooth":
            assert len(moment.added) == len(moment.removed) == 0
    assert film.title(0) == "Start"
    assert [m.state for m in film.moments(film.stops(3))] == film.stops(3)
    assert film.stops(4)[-1] == len(film) - 1


def test_figure_as_png_has_the_colours_of_its_theme(walked):
    for name, colours in THEMES.items():
        options = FigureOptions(size=(400, 300), theme=name)
        moment = Film(walked).moment(4)
        image = np.asarray(raster(figure(walked.mesh, options, moment))).reshape(-1, 3).astype(int)
        for colour in (colours.plus, colours.minus, colours.background, colours.fill):
            wanted = [int(colour[i : i + 2], 16) for i in (1, 3, 5)]
            assert np.abs(image - wanted).max(axis=1).min() <= 6
    plain = figure(walked.mesh, FigureOptions(size=(400, 300), score=False, numbers=False))
    assert not [shape for shape in plain.shapes if type(shape).__name__ == "Text"]


def test_pictures_need_neither_display_nor_vtk(tmp_path):
    code = (
        "import sys; from meshwright.graphics.export import export_job; "
        "from meshwright.graphics.mesh_figure import FigureOptions; "
        "from meshwright_core.domains import gallery, meshing; "
        "m = meshing.mesh_domain(gallery.shape('star'), 'quad'); "
        "options = FigureOptions((300, 200), 'dark'); "
        f"export_job.save_mesh_picture(m, r'{tmp_path / 'star.png'}', options); "
        "assert not {'vtkmodules', 'pyvista', 'qtpy', 'torch'} & set(sys.modules)"
    )
    environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
    done = subprocess.run([sys.executable, "-c", code], env=environment, timeout=100, check=False)
    assert done.returncode == 0
    with Image.open(tmp_path / "star.png") as image:
        assert image.size == (300, 200)


def test_summary(star, triangles):
    assert summary(star) == "s 12, optimum 4, 24 quads"
    assert summary(triangles).endswith("triangles")


def test_figure_as_svg_is_well_formed_and_has_its_text(walked):
    text = svg(figure(walked.mesh, SMALL, Film(walked).moment(2)))
    root = ElementTree.fromstring(text)
    assert root.get("viewBox") == "0 0 320 240"
    words = [element.text for element in root.iter() if element.tag.endswith("text")]
    assert f"s {walked.mesh.score}" in words
    discs = [e for e in root.iter() if e.tag.endswith("circle")]
    assert len(discs) >= 2 * walked.mesh.irregular_count
    path = max((e.get("d", "") for e in root.iter() if e.tag.endswith("path")), key=len)
    assert not re.search(r"nan|inf|e-", path)
    strange = svg(Drawing((10, 10), "#ffffff", "a < b & c"))
    assert ElementTree.fromstring(strange)[0].text == "a < b & c"


def test_inverted_elements_are_hatched(strip):
    plain = len(figure(strip, SMALL).shapes)
    strip.move([1], np.array([[1.0, 1.4, 0.0]]))
    drawn = figure(strip, SMALL)
    hatched = [s for s in drawn.shapes if getattr(s, "colour", "") == THEMES["light"].warning]
    assert len(hatched) == 2
    assert len(drawn.shapes) == plain + 2
    square = np.array([(0, 0), (10, 0), (10, 10), (0, 10)], dtype=float)
    lines = hatching(square, 2.0)
    assert len(lines) == 8  # the first one in the corner
    assert np.ptp(lines.sum(axis=2), axis=1).max() < 1e-9
    assert ((lines >= -1e-9) & (lines <= 10 + 1e-9)).all()


def test_areas_with_holes_in_png_and_svg():
    outer = np.array([(0, 0), (20, 0), (20, 20), (0, 20)], dtype=float)
    hole = outer * 0.4 + 6
    drawing = Drawing((20, 20), "#ffffff", shapes=[Area([outer, hole], "#000000")])
    drawing.add(Segments(np.empty((0, 2, 2)), "#ff0000", 1.0, 3.0))
    image = raster(drawing)
    assert image.getpixel((10, 10)) == (255, 255, 255)
    assert image.getpixel((2, 2)) == (0, 0, 0)
    assert svg(drawing).count("evenodd") == 1


def test_gif_has_one_frame_with_its_duration_for_each_state(walked, tmp_path):
    film, path = Film(walked), tmp_path / "star.gif"
    seen = []
    assert film.save(path, SMALL, 0.2, progress=lambda *done: seen.append(done)) == len(film)
    assert seen[-1] == (len(film), len(film))
    with Image.open(path) as image:
        assert image.n_frames == len(film)
        assert image.info["loop"] == 0
        times = []
        for frame in range(image.n_frames):
            image.seek(frame)
            times.append(image.info["duration"])
        assert times == [1000, *[200] * (len(film) - 2), 2500]
        last = np.asarray(image.convert("RGB")).astype(int)
    film.go_to(len(film) - 1)
    wanted = next(film.images([len(film) - 1], SMALL))
    assert np.abs(last - np.asarray(wanted)).mean() < 1.0


def test_mp4_duration(walked, tmp_path):
    import av

    film, path = Film(walked), tmp_path / "star.mp4"
    frames = film.save(path, FigureOptions(size=(321, 241), theme="dark"), 0.25, every=2)
    wanted = 1.0 + 0.25 * (frames - 2) + 2.5
    with av.open(str(path)) as file:
        stream = file.streams.video[0]
        assert (stream.width, stream.height) == (320, 240)
        assert stream.codec_context.name in ("h264", "libx264")
        assert float(file.duration) / av.time_base == pytest.approx(wanted, abs=0.06)


@pytest.mark.parametrize("ending", [".gif", ".mp4", ".png", ".svg"])
def test_cancelled_or_failed_export_leaves_no_file(walked, tmp_path, ending):
    film, path = Film(walked), tmp_path / f"star{ending}"
    order = ExportOptions(ending=ending, size=(320, 240))

    def stop(done, total):
        raise KeyboardInterrupt

    if order.moving:
        path.write_bytes(b"before")
        with pytest.raises(KeyboardInterrupt):
            export_job.write_export(film, order, path, stop)
        assert path.read_bytes() == b"before"
    assert export_job.write_export(film, order, path) == (len(film) if order.moving else 1)
    assert path.stat().st_size > 500
    assert [found.name for found in tmp_path.iterdir()] == [path.name]
    with pytest.raises(MeshError, match="does not exist"):
        export_job.write_export(film, order, tmp_path / "none" / path.name)


def test_exported_picture_shows_the_present_state_of_the_film(walked, tmp_path):
    film = Film(walked)
    state = film.state
    export_job.write_export(film, ExportOptions(ending=".svg"), tmp_path / "a.svg")
    assert film.state == state
    assert f">s {walked.mesh.score}<" in (tmp_path / "a.svg").read_text()


def test_other_endings_are_refused(walked, tmp_path):
    for name in ("film.avi", "film"):
        with pytest.raises(MeshError, match=r"\.gif or \.mp4"):
            Film(walked).save(tmp_path / name)
        with pytest.raises(MeshError, match=r"\.png or \.svg"):
            export_job.save_mesh_picture(walked.mesh, tmp_path / name)
    with pytest.raises(MeshError, match="no mesh"):
        Film(Document())


def test_film_of_a_long_history_skips_steps(walked):
    film = Film(walked)
    assert ExportOptions().stride(film) == 1
    film.rows = film.rows * 1000
    assert len(film.stops(ExportOptions().stride(film))) <= export_job.MOST_FRAMES + 1


def test_gif_palette_has_the_colours_of_the_theme():
    for colours in THEMES.values():
        rows = np.array(video.palette(colours)).reshape(-1, 3).tolist()
        assert len(rows) == 256
        for colour in (colours.background, colours.fill, colours.plus, colours.minus, colours.text):
            assert [int(colour[i : i + 2], 16) for i in (1, 3, 5)] in rows


def test_a_film_of_a_run(star, greedy):
    runner = greedy(star)
    operations = []
    while not runner.finished:
        operations += runner.step()
    score = star.score
    film = Film.of_run(star, operations, "greedy", "star")
    assert star.score == score
    assert isinstance(film.mesh, HalfEdgeMesh)
    assert film.scores[0] == score
    assert film.scores[-1] == runner.mesh.score
    assert film.rows[-1].action == "smooth"
    assert len(smoothing.relax(film.mesh)) == 0
