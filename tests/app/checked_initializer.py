# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""opencv_initializer.py with a check of windows and answers against their schemas. A violation is
reported as a failure."""
import json
import pathlib
import sys

import jsonschema

ENGINE = pathlib.Path(__file__).resolve().parents[2] / "engine"
sys.path.insert(0, str(ENGINE / "examples/peers"))
import opencv_initializer  # noqa: E402


def schema(name):
    return jsonschema.Draft202012Validator(json.loads((ENGINE / "external_methods" / name).read_text()))


def check(name, value):
    for error in schema(name).iter_errors(value):
        raise ValueError(f"{name}: {error.json_path}: {error.message[:200]}")


for line in sys.stdin:
    try:
        window = json.loads(line)
        check("method_window.schema.json", window)
        answer = opencv_initializer.initialize(window)
        check("method_answer.schema.json", answer)
        check("method_answer.schema.json", {"failed": "why"})
    except (ValueError, opencv_initializer.Failed) as why:
        answer = {"failed": str(why)}
    print(json.dumps(answer), flush=True)
