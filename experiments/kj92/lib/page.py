"""Writes the page: one HTML file with embedded pictures, and a shorter Markdown version."""

import base64
import csv
import html
import os
import re
from dataclasses import dataclass, field

STYLE = """
body { font: 16px/1.5 Georgia, serif; max-width: 70rem; margin: 2rem auto; padding: 0 1rem;
       color: #222; background: #fff }
h1, h2, th, nav, figcaption { font-family: system-ui, sans-serif }
h1 { font-size: 1.6rem } h2 { font-size: 1.2rem; margin-top: 3rem; border-top: 1px solid #ccc;
     padding-top: 1rem }
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; align-items: flex-start }
figure { margin: 0 } figure img { display: block; max-width: 100%; height: auto }
figcaption { font-size: .8rem; color: #444; margin-top: .3rem; max-width: 36rem }
table { border-collapse: collapse; font: .8rem system-ui, sans-serif; margin: 1rem 0 }
th, td { padding: .15rem .6rem; border-bottom: 1px solid #ddd; text-align: right }
th:first-child, td:first-child, td.words { text-align: left }
pre { background: #f4f4f2; padding: .6rem; overflow-x: auto; font-size: .75rem; line-height: 1.35 }
code { font-size: .85em } details { margin: .8rem 0 } summary { cursor: pointer }
.scroll { overflow-x: auto }
"""


@dataclass
class Picture:
    file: str  # in the output folder
    caption: str
    width: int = 0  # shown width in pixels; 0: the picture's own


@dataclass
class Table:
    file: str  # CSV in the output folder
    header: list
    rows: list  # of strings or numbers
    is_folded: bool = False


@dataclass
class Section:
    text: list  # paragraphs; `code` between backquotes
    pictures: list = field(default_factory=list)
    tables: list = field(default_factory=list)
    commands: list = field(default_factory=list)  # in addition to those of the renders


def shown(value):
    if isinstance(value, float):
        return "–" if value != value else f"{value:.4g}"
    return str(value)


def write_csv(out, table):
    with open(f"{out}/{table.file}", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(table.header)
        for row in table.rows:
            writer.writerow([f"{v:.6g}" if isinstance(v, float) else v for v in row])


def _inline(text):
    """Converts the Markdown in texts: `code`, **strong**, *emphasis*."""
    text = re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(text, quote=False))
    text = re.sub(r"\*\*([^*]+)\*\*", r"<strong>\1</strong>", text)
    return re.sub(r"\*([^*]+)\*", r"<em>\1</em>", text)


def _picture(out, p):
    with open(f"{out}/{p.file}", "rb") as file:
        data = base64.b64encode(file.read()).decode()
    width = f' width="{p.width}"' if p.width else ""
    return (f'<figure><img{width} alt="{html.escape(p.caption)}" '
            f'src="data:image/png;base64,{data}">'
            f"<figcaption>{_inline(p.caption)} ({p.file})</figcaption></figure>")


def _cell(value, tag="td"):
    words = ' class="words"' if isinstance(value, str) and tag == "td" and len(value) > 12 else ""
    return f"<{tag}{words}>{_inline(shown(value))}</{tag}>"


def _table(t):
    head = "".join(_cell(h, "th") for h in t.header)
    rows = "\n".join("<tr>" + "".join(_cell(v) for v in row) + "</tr>" for row in t.rows)
    body = f'<div class="scroll"><table><tr>{head}</tr>\n{rows}</table></div>'
    if t.is_folded:
        return f"<details><summary>{t.file}, {len(t.rows)} rows</summary>{body}</details>"
    return body + f"<figcaption>{t.file}</figcaption>"


def _commands(commands):
    if not commands:
        return ""
    text = html.escape("\n".join(commands), quote=False)
    if len(commands) <= 4:
        return f"<pre>{text}</pre>"
    return f"<details><summary>{len(commands)} commands</summary><pre>{text}</pre></details>"


def write_html(out, title, introduction, sections):
    """sections: [(experiment, section)]."""
    parts = [f"<!doctype html><html lang=en><meta charset=utf-8><title>{title}</title>",
             '<meta name=viewport content="width=device-width">', f"<style>{STYLE}</style>",
             f"<h1>{title}</h1>", *(f"<p>{_inline(p)}</p>" for p in introduction), "<nav><ul>"]
    parts += [f'<li><a href="#{e.name}">{html.escape(e.title)}</a></li>' for e, _ in sections]
    parts.append("</ul></nav>")
    for experiment, s in sections:
        parts.append(f'<h2 id="{experiment.name}">{html.escape(experiment.title)}</h2>')
        parts.append('<div class="pictures">' + "\n".join(_picture(out, p) for p in s.pictures)
                     + "</div>")
        parts += [_table(t) for t in s.tables]
        parts += [f"<p>{_inline(p)}</p>" for p in s.text]
        parts.append(_commands(s.commands))
    with open(f"{out}/index.html", "w") as file:
        file.write("\n".join(parts))


def write_markdown(out, title, introduction, sections):
    lines = [f"# {title}", "", *(p + "\n" for p in introduction),
             "[index.html](index.html) is all of this on one page, with every command.", ""]
    for experiment, s in sections:
        lines += [f"## {experiment.title}", ""]
        for p in s.text:
            lines += [p, ""]
        # Several pictures appear side by side, as separate files.
        row = " ".join(f"![{p.caption.replace('`', '')}]({p.file})" for p in s.pictures)
        lines += [row, ""] if row else []
        tables = ", ".join(f"[{t.file}]({t.file})" for t in s.tables)
        lines += [f"Numbers: {tables}", ""] if tables else []
    with open(f"{out}/README.md", "w") as file:
        file.write("\n".join(lines).rstrip() + "\n")


def files_of(sections):
    """Returns the names of all files that belong to the page."""
    files = ["index.html", "README.md"]
    for _, s in sections:
        files += [p.file for p in s.pictures] + [t.file for t in s.tables]
    return [f for f in files if os.path.basename(f) == f]
