"""A self-contained HTML page from sections of text, pictures and tables; no link leaves it and it prints on A4."""

import base64
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib.resources import files


@dataclass(frozen=True)
class Picture:
    """A picture as the bytes of a PNG file, with its caption."""

    png: bytes
    caption: str

    @property
    def base64(self) -> str:
        """The bytes as text for a data URI."""
        return base64.b64encode(self.png).decode("ascii")


@dataclass(frozen=True)
class Table:
    """Rows of text; `left` and `wrap` are the columns set flush left and allowed to wrap."""

    rows: Sequence[Sequence[str]]
    head: Sequence[str] = ()
    caption: str = ""
    left: frozenset[int] = frozenset({0})
    wrap: frozenset[int] = frozenset()


@dataclass(frozen=True)
class Section:
    """A numbered part of the page."""

    title: str
    paragraphs: Sequence[str] = ()
    pictures: Sequence[Picture] = ()
    tables: Sequence[Table] = ()
    notes: Sequence[str] = ()
    verbatim: str = ""
    narrow: bool = field(default=False)


def render_page(title: str, sections: Sequence[Section], *, lead: str = "", facts: Sequence[tuple[str, str]] = ()) -> str:
    """Return the page as HTML.

    Parameters
    ----------
    title : str
    sections : sequence of Section
    lead : str
        One line below the title.
    facts : sequence of (str, str)
        Name and value of what a reader wants first.

    Examples
    --------
    >>> page = render_page("Box & barge", [Section("Hull", ["A box."])])
    >>> "Box &amp; barge" in page, "http" in page
    (True, False)
    """
    from jinja2 import Environment, StrictUndefined

    from ogilvie import __version__

    template = files("ogilvie.post").joinpath("templates", "report.html.j2").read_text(encoding="utf-8")
    environment = Environment(autoescape=True, undefined=StrictUndefined)
    return environment.from_string(template).render(title=title, lead=lead, facts=facts, sections=sections, version=__version__)
