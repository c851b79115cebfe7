"""The report as PDF and DOCX: the same as the page, and no table that fits on a sheet is split."""

import pypdfium2
import pytest
from docx import Document
from docx.oxml.ns import qn

import catenary_stand_in as stand_in
from ancf import ModelError
from ancf.catenary.report import Content, build, write_report, write_reports
from ancf.catenary.report.build import pieces
from ancf.viz import printed, style
from ancf.viz.html import element, figure, pairs, table
from ancf.viz.printed.blocks import Cell, Picture, Table, blocks


@pytest.fixture(scope="module")
def content():
    return Content.of(stand_in.run(count=2), elasticity=stand_in.elasticity())


@pytest.fixture(scope="module")
def folder(content, tmp_path_factory):
    made = tmp_path_factory.mktemp("printed")
    write_reports(content.run, made, ("html", "pdf", "docx"), elasticity=content.elasticity)
    return made


@pytest.fixture(scope="module")
def tables(content):
    """Tables of the report with their last heading."""
    found, heading = {}, ""
    for block in blocks(pieces(content, "title", save=lambda _: b"png")):
        if isinstance(block, Table):
            found[heading] = block
        elif hasattr(block, "level"):
            heading = block.text
    return found


def pages(path):
    document = pypdfium2.PdfDocument(path)
    return [" ".join(page.get_textpage().get_text_range().split()) for page in document]


def words(cells):
    return " ".join(cell.text for cell in cells).split()


class TestPdf:
    def test_has_all_texts(self, folder, tables):
        text = "".join(pages(folder / "report.pdf")).replace(" ", "")
        for name, found in tables.items():
            assert name.replace(" ", "") in text
            for row in found.rows:
                for word in words(row):
                    assert word in text, (name, word)

    def test_no_table_is_split_that_fits(self, folder, tables):
        """The first and the last row stand on the page of their heading; the dropper schedule is longer."""
        sheets = pages(folder / "report.pdf")
        long = [name for name, found in tables.items() if len(found.rows) > 60]
        assert long == ["Dropper schedule"]
        for name, found in tables.items():
            if name in long:
                continue
            ends = ["".join(words(found.rows[k])) for k in (0, -1)]
            near = [s.replace(" ", "") for s in sheets]
            assert any(name.replace(" ", "") in s and all(end in s for end in ends) for s in near), name

    def test_heads_come_again(self, folder):
        heads = [page for page in pages(folder / "report.pdf") if "messenger at [mm]" in page]
        assert len(heads) >= 2

    def test_the_same_twice(self, tmp_path):
        page = [element("h1", "A"), element("p", "a < b & σ ≤ 0.3"), pairs([("x", "1")])]
        one, two = (printed.write_printed(tmp_path / f"{k}.pdf", "A", page) for k in (1, 2))
        assert one.read_bytes() == two.read_bytes()
        assert "a < b & σ ≤ 0.3" in pages(one)[0]

    @pytest.mark.parametrize("count", [1, 45, 200])
    @pytest.mark.parametrize("columns", [1, 6, 14])
    def test_tables_of_all_sizes(self, tmp_path, count, columns):
        rows = [[f"{i}/{j}" for j in range(columns)] for i in range(count)]
        made = table([f"column {j}" for j in range(columns)], rows, numbers=range(columns))
        path = printed.write_printed(tmp_path / "t.pdf", "T", [element("h2", "Rows"), made])
        sheets = pages(path)
        assert len(sheets) == (1 if count <= 45 else len(sheets))
        assert all("column 0" in sheet.replace("column\n", "column ") for sheet in sheets)
        text = " ".join(sheets)
        assert all(row[-1] in text for row in rows)


class TestDocx:
    def test_has_the_same_tables(self, folder, tables):
        document = Document(folder / "report.docx")
        texts = [[[cell.text for cell in row.cells] for row in made.rows] for made in document.tables]
        assert texts == [[[cell.text for cell in row] for row in found.rows] for found in tables.values()]

    def test_rows_are_not_split_and_heads_are_repeated(self, folder, tables):
        for made, found in zip(Document(folder / "report.docx").tables, tables.values(), strict=True):
            for k, row in enumerate(made.rows):
                assert row._tr.trPr.find(qn("w:cantSplit")) is not None
                assert (row._tr.trPr.find(qn("w:tblHeader")) is not None) == (k < found.heads)
            kept = [row.cells[0].paragraphs[0].paragraph_format.keep_with_next for row in made.rows]
            assert kept == [len(made.rows) <= 45 and k + 1 < len(made.rows) for k in range(len(made.rows))]

    def test_pictures_and_title(self, folder, content):
        document = Document(folder / "report.docx")
        assert len(document.inline_shapes) == 10
        assert document.core_properties.title == "EN 50318:2002 reference model, 250 km/h"
        wide = document.sections[0].page_width - document.sections[0].left_margin
        assert all(shape.width < wide for shape in document.inline_shapes)


class TestBlocks:
    def test_cells(self):
        made = table(("a", "b"), [("x", "outside")], numbers=(1,))
        made.find(".//tbody/tr")[1].set("class", "number outside")
        (found,) = blocks([made])
        assert found.rows[1] == (Cell("x"), Cell("outside", number=True, kind="outside"))
        assert found.heads == 1
        assert sum(found.widths()) == pytest.approx(1.0)

    @pytest.mark.parametrize("tone", ["", "inside", "outside"])
    def test_tone_of_a_verdict(self, tone, tmp_path):
        """On paper its text has the colour of cells that say the same."""
        box = element("p", "All of it.", class_=f"verdict {tone}".strip())
        [block] = blocks([box])
        assert (block.text, block.kind, block.tone) == ("All of it.", "verdict", tone)
        rows = table(("verdict",), [(tone,)])
        for cell in rows.iter("td"):
            cell.set("class", tone)
        for kind in ("docx", "pdf"):
            printed.write_printed(tmp_path / f"box.{kind}", "title", [box, rows])
        document = Document(tmp_path / "box.docx")
        said = next(p.runs[0] for p in document.paragraphs if p.text == "All of it.").font.color.rgb
        cell = document.tables[0].rows[1].cells[0].paragraphs[0].runs[0].font.color.rgb
        assert said == cell
        assert (said is None) == (tone == "")
        assert "All of it." in " ".join(pages(tmp_path / "box.pdf"))

    def test_picture(self):
        with style.new_figure(40.0, 30.0) as drawing:
            drawn = style.png(drawing)
        (found,) = blocks([figure("name", "Title", "What it is.", drawn)])
        assert found == Picture(drawn, "Title.", "What it is.")

    def test_svg_is_refused(self):
        with pytest.raises(ModelError, match="has a picture that is no PNG"):
            list(blocks([figure("name", "Title", "Text", "<svg/>")]))


class TestFormats:
    def test_all_by_default(self):
        assert printed.chosen(None) == ("html", "pdf", "docx")
        assert printed.chosen("docx, pdf") == ("docx", "pdf")

    def test_unknown(self):
        with pytest.raises(ModelError, match=r"--to: .*html.*pdf.*docx"):
            printed.chosen("html,odt")

    def test_missing_package(self, monkeypatch):
        monkeypatch.setattr("ancf.viz.printed.formats.find_spec", lambda name: None)
        assert printed.chosen(None) == ("html",)
        with pytest.raises(ModelError, match=r"reportlab is not installed.*\(pip install 'ancf\[report\]'\)"):
            printed.chosen("pdf")

    def test_one_file(self, content, tmp_path):
        path = write_report(content.run, tmp_path / "deep" / "one.pdf")
        assert path.read_bytes().startswith(b"%PDF")

    def test_a_place_that_cannot_be_written(self, content, tmp_path, monkeypatch):
        """Before anything is drawn."""
        (tmp_path / "file").write_text("")
        monkeypatch.setattr(build, "pieces", lambda *given: pytest.fail("it draws first"))
        with pytest.raises(ModelError, match="cannot be written"):
            write_report(content.run, tmp_path / "file" / "report.pdf")
