#!/usr/bin/env python3
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the English of comments, strings, test names and Markdown pages.

  tests/prose_check.py [PATH...]     prints each violation as PATH:LINE: RULE: TEXT and exits with 1 if there is one
  tests/prose_check.py --count [PATH...]   prints the number of violations of each rule
  tests/prose_check.py --examples    checks that the rules find what they must find

Rules: no sentence starts with a fragment word ("Of", "What", "Who", "Where", ...) in place of its subject, and none of
the words that have a standard term is used for it. EXCEPTIONS lists what is allowed, with the reason.
"""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PATHS = "README.md CMakeLists.txt run.sh test.sh .ci app assets engine tests ui".split()
SKIPPED = re.compile(r"^(tests/fuzz/(seeds|crashes)|sequences|assets/nine/.*\.yaml|LICENSE)|prose_check\.py$")
CODE = re.compile(r"\.(h|cpp)$")
SCRIPT = re.compile(r"(\.(py|pyi|sh|cmake)|CMakeLists\.txt|^\.ci/.*)$")

# A sentence that starts with one of these has no subject, unless it is a question.
FRAGMENT = re.compile(r"(Of|As|What|Who|Whose|Whoever|Whatever|Wherever|Where|Those|Nothing|Nobody|Somebody|Whether)\b")
SENTENCE = re.compile(r"(?:^|(?<=[.;!?] )|(?<=: ))([A-Za-z][^.;!?]*[.;!?]?)")

# Word or phrase -> what to write.
WORDS = {
    r"pictures?": "image",
    r"soft(ened)? (image|picture)s?": "smoothed image",
    r"row pace|pace": "row delay, rate",
    r"(gyro(scope)?'?s? )?turns of": "rotations",
    r"sights?|sighted": "observation, view",
    r"(is|are|was|were|be) (told|said)\b(?! to)": "is reported, is estimated, is given",
    r"(tells|tell) (the|a|an|how|what|which|where|them|it|one|of|by|from)": "determine, estimate, report",
    r"(told|tells) by": "determined by",
    r"surest|surer|certain to": "uncertainty, lowest uncertainty",
    r"what holds against|own way": "reason for rejection, baseline",
    r"glances?|adopts?": "probe, apply",
    r"nobody|somebody|whoever": "no one, the caller, the user",
    r"held against": "compared with",
    r"stood still": "was stationary",
    r"looks? of (a|the) (track|point)": "patch template",
    r"wishe[ds]|heeds?|heeded": "requests, handles",
    r"goes with|belongs? to (no|none)": "applies to",
    r"so many|so much": "the number, the amount",
    r"(is|are) charged with": "names the actor",
    r"comes to be": "becomes",
}
WORD = re.compile(r"\b(?:" + "|".join(f"(?P<w{i}>{pattern})" for i, pattern in enumerate(WORDS)) + r")\b", re.I)

# (path, part of the text): reason
EXCEPTIONS = {
    ("engine/examples/live_camera_loop.cpp", "--picture"): "an option of the example that users rely on",
    ("engine/recording/recording.h", '"pictures"'): "a key of experiment.json",
    ("engine/recording/recording.cpp", "picture size"): "a key of experiment.json",
}

TOKEN = re.compile(r'//[^\n]*|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'')


def blocks(lines):
    """Joins (line, words, continues the line above) to blocks; yields (first line, text, is a comment)."""
    block, begin, last = [], 0, -2
    for line, words, continues in lines:
        if block and not (continues and last == line - 1):
            yield begin, " ".join(block), True
            block = []
        if not block:
            begin = line
        block.append(words)
        last = line
    if block:
        yield begin, " ".join(block), True


def code_texts(text):
    """Yields (line, text, is a comment) of each comment block and each string literal of a C++ source."""
    comments = []
    for match in TOKEN.finditer(text):
        token = match[0]
        line = text.count("\n", 0, match.start()) + 1
        before = text[text.rfind("\n", 0, match.start()) + 1:match.start()].strip()
        if token.startswith("//"):
            comments.append((line, token.lstrip("/<! ").strip(), not before))
        elif token.startswith('"') and len(token) > 2 and not before.endswith("include"):
            yield line, token[1:-1].replace("\\n", " ").replace('\\"', '"'), False
    yield from blocks(comments)


def script_texts(text):
    """Yields (line, text, True) of each comment block of a script."""
    lines = enumerate((line.strip() for line in text.split("\n")), 1)
    return blocks((n, line.lstrip("# "), True) for n, line in lines if re.match(r"#(?!!)", line))


def page_texts(text):
    """Yields (line, text, True) of each paragraph, list entry and table cell of a Markdown page, without its code."""
    text = re.sub(r"```.*?```", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
    lines = []
    for number, line in enumerate(text.split("\n"), 1):
        starts = re.match(r"\s*([-*|>#]|\d+\.)\s*", line)
        cells = line.strip("| ").split("|") if line.lstrip().startswith("|") else [line]
        for cell in cells if line.strip() else []:
            lines.append((number, re.sub(r"^([-*>#]|\d+\.)+\s*", "", cell.strip()), not starts))
    return blocks(lines)


def violations(path, text):
    kind = code_texts if CODE.search(path) else script_texts if SCRIPT.search(path) else page_texts
    for line, block, comment in kind(text):
        if not comment and path.startswith("tests/"):  # an input or an expected output
            continue
        plain = re.sub(r"`[^`]*`", "`x`", block).replace("**", "")
        if path == "README.md":
            for sentence in re.split(r"(?<=[.!?])\s", plain):
                if len(sentence.split()) > 30:
                    yield line, "longer than 30 words", sentence
        for sentence in SENTENCE.findall(plain):
            if FRAGMENT.match(sentence) and not sentence.endswith("?"):
                yield line, "fragment", sentence.strip()
        if re.match(r"(of|as|what|who|whose|whoever|where|those|nothing|nobody)\b", plain) and comment and kind is not page_texts:
            yield line, "fragment", plain.strip()
        if re.search(r"[A-Za-z] [A-Za-z]", plain) or kind is not code_texts:
            for match in WORD.finditer(plain):
                rule = list(WORDS.values())[int(match.lastgroup[1:])] if match.lastgroup else ""
                yield line, f"'{match[0]}' -> {rule}", plain.strip()
    for match in re.finditer(r"TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", text):
        if re.match(r"(Of|What|Who|Whose|Whoever|Where|Those|Nothing|Nobody|That|Whether|As)[A-Z]", match[2]):
            yield text.count("\n", 0, match.start()) + 1, "test name", match[2]


def allowed(path, text):
    return any(path == p and part in text for p, part in EXCEPTIONS)


def checked_files(roots):
    """Yields the paths below the roots, relative to the repository, that have prose."""
    for root in roots:
        top = ROOT / root
        for file in sorted(top.rglob("*")) if top.is_dir() else [top]:
            path = file.relative_to(ROOT).as_posix()
            has_prose = CODE.search(path) or SCRIPT.search(path) or path.endswith(".md")
            if file.is_file() and has_prose and not SKIPPED.search(path):
                yield path


# Text that the check must find, as a source of this name.
EXAMPLES = {
    "a.h": "/// Of a coordinate's noise, as the residuals tell it [px^2].\nint a;  ///< what it is\n",
    "b.cpp": 'throw Error("the picture is told by nobody");\nTEST(A, WhatNobodyCalibrated) {}\n',
    "c.md": "Where it is known, the pace is 3.\n",
    "d.sh": "# Who runs it.\n",
}


def check_examples():
    missed = [path for path, text in EXAMPLES.items() if not list(violations(path, text))]
    for path in missed:
        print(f"example {path} has no violation")
    return 1 if missed else 0


def main(arguments):
    if arguments == ["--examples"]:
        return check_examples()
    count = "--count" in arguments
    roots = [a for a in arguments if not a.startswith("--")] or [*PATHS]
    rules = collections.Counter()
    for path in checked_files(roots):
        for line, rule, text in violations(path, (ROOT / path).read_text()):
            if allowed(path, text):
                continue
            rules[rule.lower()] += 1
            if not count:
                print(f"{path}:{line}: {rule}: {text[:150]}")
    if count:
        for rule, number in rules.most_common():
            print(f"{number:6} {rule}")
    print(f"{sum(rules.values())} violations")
    return 1 if rules else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
