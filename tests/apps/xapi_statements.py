# SPDX-License-Identifier: AGPL-3.0-or-later
"""xAPI statements of real attempts against the rules of xAPI 1.0.3, part two: what a record store refuses.

  xapi_statements.py ARTUS      plays three attempts, one with aids, exports them and reads every statement"""
import datetime, json, pathlib, re, subprocess, sys, tempfile, uuid

UUID = re.compile(r"[0-9a-f]{8}-[0-9a-f]{4}-[1-5][0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}")  # RFC 4122
IRI = re.compile(r"[a-z][a-z0-9+.-]*:[^\s<>\"{}|\\^`]+", re.I)  # RFC 3987, absolute
DURATION = re.compile(r"P(?!$)(\d+Y)?(\d+M)?(\d+D)?(T(?!$)(\d+H)?(\d+M)?(\d+(\.\d{1,2})?S)?)?")  # ISO 8601
TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d)")  # RFC 3339
LANGUAGE = re.compile(r"[a-z]{2,3}(-[A-Za-z0-9]{2,8})*")  # RFC 5646
VERBS = {"passed", "failed", "attempted"}


def of(text, rule, what):
    assert isinstance(text, str) and rule.fullmatch(text), f"{what}: {text!r}"


def language_map(names, what):
    assert isinstance(names, dict) and names, what
    for tag, text in names.items():
        of(tag, LANGUAGE, what)
        assert isinstance(text, str) and text, what


def no_null(value, what):
    """4.1.1: no value is null, nor an empty object, but in extensions."""
    assert value is not None and value != {}, what
    if isinstance(value, dict):
        for key, inner in value.items():
            if key != "extensions":
                no_null(inner, f"{what}.{key}")


def statement(s):
    assert set(s) <= {"id", "actor", "verb", "object", "result", "context", "timestamp", "stored", "authority", "version", "attachments"}, set(s)
    no_null(s, "statement")
    of(s["id"], UUID, "id")
    uuid.UUID(s["id"])
    of(s["version"], re.compile(r"1\.0\.\d+"), "version")
    actor = s["actor"]
    assert actor.get("objectType", "Agent") == "Agent"
    assert len({"mbox", "mbox_sha1sum", "openid", "account"} & set(actor)) == 1, "one inverse functional identifier"
    assert set(actor["account"]) == {"homePage", "name"} and actor["account"]["name"]
    of(actor["account"]["homePage"], IRI, "homePage")
    of(s["verb"]["id"], IRI, "verb")
    assert s["verb"]["id"].rsplit("/", 1)[-1] in VERBS
    language_map(s["verb"]["display"], "verb.display")
    assert s["object"].get("objectType", "Activity") == "Activity"
    of(s["object"]["id"], IRI, "object")
    of(s["object"]["definition"]["type"], IRI, "object.definition.type")
    language_map(s["object"]["definition"]["name"], "object.definition.name")
    of(s["timestamp"], TIME, "timestamp")
    assert datetime.datetime.fromisoformat(s["timestamp"].replace("Z", "+00:00")).tzinfo is not None
    result = s["result"]
    of(result["duration"], DURATION, "duration")
    for key in result["extensions"]:
        of(key, IRI, "extension")
    if "score" in result:
        score = result["score"]
        assert -1 <= score["scaled"] <= 1 and score["min"] <= score["raw"] <= score["max"], score
        assert isinstance(result["success"], bool)


def main():
    def artus(*arguments, fails=False):
        done = subprocess.run([sys.argv[1], *map(str, arguments)], capture_output=True, text=True)
        assert (done.returncode != 0) == fails, (arguments, done.stderr)
        return done.stdout

    with tempfile.TemporaryDirectory() as folder:
        db = pathlib.Path(folder) / "records.db"
        artus("learners", "add", "--records", db, "--person", "p1")
        for seed, operator in ((1, "expert"), (2, "novice")):
            artus("play", "gel-find", "--operator", operator, "--seed", seed, "--rigid", "--records", db, "--person", "p1")
        artus("play", "gel-look", "--operator", "expert", "--rigid", "--records", db, "--person", "p1")
        export = ("learners", "export", "--records", db, "--format", "xapi", "--home")
        for home in ("https://school.example", "https://school.example/"):
            statements = json.loads(artus(*export, home))
            for s in statements:
                statement(s)
            assert len(statements) == 3 and len({s["id"] for s in statements}) == 3
        for home in ("school", "", "https://school example"):
            artus(*export, home, fails=True)
    print(f"{len(statements)} statements as xAPI 1.0.3 asks for")


if __name__ == "__main__":
    main()
