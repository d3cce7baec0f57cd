"""What the programs print under --json, held against its schemas."""
import json
import os

import jsonschema

SOURCE_DIR = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# Of standard output. `drtv validate` prints one object as well: report.schema.json.
SCHEMAS = {
    ("drtv", "validate"): "format/report.schema.json",
    ("drtv", "dump"): "format/dump.schema.json",
    ("drtv", "diff"): "format/diff.schema.json",
    ("drtv", "relight"): "format/relight.schema.json",
    ("bakerd", "render"): "bakerd/picture/pick.schema.json",
    "bake": "client/bake.schema.json",
    "sectors": "format/sectors.schema.json",
    "messages": "format/message.schema.json",
}
_validators = {}


def validator(key):
    if key not in _validators:
        with open(os.path.join(SOURCE_DIR, SCHEMAS[key]), encoding="utf-8") as file:
            schema = json.load(file)
        jsonschema.Draft202012Validator.check_schema(schema)
        _validators[key] = jsonschema.Draft202012Validator(schema)
    return _validators[key]


def check(program, command, stdout):
    """Each line of standard output is an object of its schema."""
    key = program if program in SCHEMAS else (program, command)
    for line in stdout.splitlines():
        validator(key).validate(json.loads(line))


def read(program, arguments, stdout, stderr):
    """Holds what a program printed against the schemas, where it was asked for JSON. Gives standard error as text."""
    if "--json" not in arguments:
        return stderr
    check(program, arguments[0], stdout)
    return messages_as_text(stderr)


def messages_as_text(stderr):
    """Standard error, whose lines are objects of their schema, as it reads without --json."""
    text = ""
    for line in stderr.splitlines():
        message = json.loads(line)
        validator("messages").validate(message)
        kind = "warning: " if message["kind"] == "warning" else ""
        text += f"{message['program']}: {kind}{message['message']}\n"
    return text
