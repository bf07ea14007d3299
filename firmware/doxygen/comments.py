#!/usr/bin/env python3
"""Doxygen's input filter: a C header whose comments are plain ones, as it would be with doxygen's marks.

`comments.py FILE` prints the header. The first comment is the file's; one that begins a line describes what follows it,
all prototypes as far as the next empty line; one after something describes that. Comments within functions, between
parentheses, in directives and of dashes stay as they are, and so does all code, line by line: doxygen's messages name
the header's own lines. Paragraphs with indented lines are examples and tables, which keep their form.
"""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path

TOKEN = re.compile(
    r"(?P<comment>/\*.*?\*/)"
    r'|"(?:\\.|[^"\\\n])*"'
    r"|(?P<bracket>[{}()])"
    r"|^[ \t]*\#(?:\\\n|/\*.*?\*/|[^\n/]|/(?!\*))*",
    re.DOTALL | re.MULTILINE,
)
"""Comments, and what may hold a bracket or a comment that is none; the last is a directive with its further lines."""

SPECIAL = re.compile(r"[\\@<>&#%]")
"""What doxygen takes for commands, tags and links."""

PROTOTYPES = re.compile(r"\n[^\n#/{}]+;(?=\n)(?P<others>(?:\n(?![ #/}])[^\n{}]*\([^\n{}]*;(?=\n))+)")
"""A declaration on one line, and prototypes on lines of their own that follow it at once."""

STARS = r"^\s*\* ?"
BLANKS = r"^\s*"

LIST_ITEM = re.compile(r"^(\s*)([-+*]|\d+[.)])(?=\s)")


def in_words_of_doxygen(text: str) -> str:
    text = SPECIAL.sub(r"\\\g<0>", text)
    text = re.sub(r"`([^`]+)`", r"<tt>\1</tt>", text)
    return LIST_ITEM.sub(r"\1&zwj;\2", text)


def paragraph(lines: list[str]) -> list[str]:
    """As many lines as it was given."""
    if not any(line.startswith("  ") for line in lines):
        return [in_words_of_doxygen(line) for line in lines]
    lines = textwrap.dedent("\n".join(lines)).split("\n")
    lines[0] = f"@verbatim {lines[0]}"
    lines[-1] += " @endverbatim"
    return lines


def body(comment: str, margin: str) -> str:
    """What stands between the comment's marks; `margin` is what its lines but the first begin with."""
    first, *others = comment[2:-2].strip().split("\n")
    others = [re.sub(margin, "", line) for line in others]
    lines: list[str] = []
    current: list[str] = []
    for line in [first, *others]:
        if line.strip():
            current.append(line.rstrip())
            continue
        lines += [*(paragraph(current) if current else []), ""]
        current = []
    return "\n".join(lines + (paragraph(current) if current else []))


class Place:
    """Where in the code the filter is: the kind of each brace that is open, and how many parentheses."""

    def __init__(self) -> None:
        self.braces: list[str] = []
        self.parentheses = 0
        self.since = 0
        """Where the text began that says what the next brace is."""

    def take(self, bracket: str, text: str, at: int) -> None:
        if bracket in "()":
            self.parentheses += 1 if bracket == "(" else -1
            return
        if bracket == "{":
            before = text[self.since : at]
            statement = re.split(r"[;}]", before)[-1]
            if "code" in self.braces or statement.rstrip().endswith((")", "=")):
                self.braces.append("code")
            else:
                self.braces.append("linkage" if 'extern "C"' in statement else "members")
        elif self.braces:
            self.braces.pop()
        self.since = at + 1

    @property
    def is_in_code(self) -> bool:
        return "code" in self.braces or self.parentheses > 0


def marked(text: str, name: str) -> str:
    """The header `text`, whose path is `name`."""
    place = Place()
    parts = [] if text.startswith("/*") else [f"/** @file {name} */ "]
    done = 0
    for token in TOKEN.finditer(text):
        if token["bracket"]:
            place.take(token["bracket"], text, token.start())
        if not token["comment"]:
            continue
        comment = token["comment"]
        before = text[text.rfind("\n", 0, token.start()) + 1 : token.start()].strip()
        if token.start() == 0:
            comment = f"/** @file {name} {body(comment, STARS)} */"
        elif place.is_in_code or comment.startswith("/* ---") or before.endswith("{"):
            continue
        elif before:
            comment = f"/**< {body(comment, BLANKS)} */"
        else:
            comment = f"/** {body(comment, STARS)} */"
        parts += [text[done : token.start()], comment]
        done = token.end()
        shared = PROTOTYPES.match(text, done)
        if shared is not None and not place.is_in_code and "members" not in place.braces:
            copy = " ".join(comment.split())
            parts += [text[done : shared.start("others")], shared["others"].replace("\n", f"\n{copy} ")]
            done = shared.end()
    return "".join([*parts, text[done:]])


def main() -> int:
    path = Path(sys.argv[1])
    sys.stdout.write(marked(path.read_text(encoding="utf-8"), "/".join(path.parts[-2:])))
    return 0


if __name__ == "__main__":
    sys.exit(main())
