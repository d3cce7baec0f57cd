#!/usr/bin/env python3
"""What comments and documents name is there: fails for a file, a section, a promise, a slide or a test that is not.

`--self-test` plants references to nothing and checks that each is found.
"""
import functools
import os
import re
import subprocess
import sys
import tempfile

# Endings of files that are read; of C-like ones the comments alone.
CODE = (".h", ".cpp", ".c", ".glsl", ".hlsl", ".wgsl", ".shader", ".proto")
HASHED = (".py", ".sh", ".cmake", "CMakeLists.txt")
DOCUMENT = (".md",)
# The past is named there, or somebody else's files are.
NOT_READ = ("CHANGELOG.md", "tests/data/", "tests/references.py", "tests/arrows.py")
# Another project's, the system's, or what a command makes.
ELSEWHERE = re.compile(
    r"^(CLI|glm|stb|zstd|tl|fmt|grpcpp|gtest|embree3|google|nlohmann|openssl|spdlog)/|^tiny_gltf\.h$"
    r"|^drtv_runtime\.(h|cpp)$|^(FILE|ANSWER|REQUEST|frame|case)\.json$|(^|/)(roles|sectors)\.json$|^data/volcano\.json$|^doc/xxhash_spec\.md$"
)
PATH = re.compile(
    r"(?<![\w/.*<>{}$-])((?:[\w-]+/)*[\w-]+(?:\.\w+)*\.(?:h|cpp|c|py|md|json|proto|sh|sql|cmake|glsl|hlsl|wgsl|shader|supp))\b(?![\w/*(-])"
)
SECTION = re.compile(r"((?:[\w/-]+/)?[\w-]+\.md),? (?:section |§ ?)?(\d+(?:\.\d+)?)\b(?! [a-z]+s\b)")
PROMISE = re.compile(r"(docs/design\.md), promise (\d+)")
SLIDE = re.compile(r"\bslides? (\d+)(?:(?: to |, | and )(\d+))?(?:(?: and |, )(\d+))?")
OLD_SLIDE = re.compile(r"(?<![\w\[.])s\d\d(?:-s\d\d)?\b(?!\[|\.| =|\(|_)")
TEST = re.compile(r"\b([A-Z]\w+)\.([A-Z][a-z]\w+)\b(?!\.\w)")


def comments_of(path, text):
    if path.endswith(DOCUMENT):
        return text
    if path.endswith(HASHED):
        hashed = re.findall(
            r"(?:^|\s)#(?!!|include|define|pragma|if|endif|else|ifdef|ifndef|undef)(.*)", text
        )
        return "\n".join(hashed + re.findall(r'"""(.*?)"""', text, re.DOTALL))
    # Texts first: they may hold what looks like a comment.
    found = re.finditer(r'"(?:\\.|[^"\\\n])*"|//([^\n]*)|/\*(.*?)\*/', text, re.DOTALL)
    return "\n".join(m.group(1) or m.group(2) or "" for m in found)


def tracked(root):
    """All files of the tree; in an archive without git, all but those that a build makes."""
    listed = subprocess.run(["git", "-C", root, "ls-files"], check=False, capture_output=True, text=True)
    if listed.returncode == 0:
        return [path for path in listed.stdout.splitlines() if os.path.exists(os.path.join(root, path))]
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [name for name in folders if name not in ("build", "node_modules", ".git")]
        found += [os.path.relpath(os.path.join(folder, name), root) for name in names]
    return sorted(found)


class Project:
    def __init__(self, root, files):
        self.root, self.files = root, dict.fromkeys(files)
        self.read = functools.cache(self.read_file)
        self.endings = set()
        for path in files:
            parts = path.split("/")
            self.endings.update("/".join(parts[n:]) for n in range(len(parts)))
        self.tests = set()
        for path in files:
            if path.startswith("tests/") and path.endswith((".cpp", ".h", ".py")):
                self.tests.update(re.findall(r"TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)", self.read(path)))
        self.suites = {suite for suite, _ in self.tests}
        design = self.read("docs/design.md")
        self.slides = set(re.findall(r"^\| (\d+) \|", design, re.MULTILINE))
        self.promises = set(re.findall(r"^(\d+)\. \*\*", design, re.MULTILINE))
        self.measurements = set(re.findall(r"^#+ (.*)$", self.read("docs/measurements.md"), re.MULTILINE))

    def read_file(self, path):
        with open(os.path.join(self.root, path), encoding="utf-8") as file:
            return file.read()

    def document(self, name, beside):
        for path in (os.path.normpath(os.path.join(os.path.dirname(beside), name)), name):
            if path in self.files:
                return path
        return next((path for path in self.files if path.endswith("/" + name)), None)

    def sections(self, path):
        return set(re.findall(r"^#+ (\d+(?:\.\d+)?)\b", self.read(path), re.MULTILINE))


def check_file(project, path):
    text = comments_of(path, project.read(path))
    for name in sorted(set(PATH.findall(text))):
        if name not in project.endings and not ELSEWHERE.search(name) and not project.document(name, path):
            yield f"{path}: names {name}, and there is no such file"
    for name, section in sorted(set(SECTION.findall(text))):
        document = project.document(name, path)
        if document and section not in project.sections(document):
            yield f"{path}: names {name}, section {section}, which {document} has not"
    for heading in sorted(set(re.findall(r'docs/measurements\.md,\s+"([^"]+)"', text))):
        if heading not in project.measurements:
            yield f"{path}: names the measurement {heading}, which docs/measurements.md has not"
    for name, promise in sorted(set(PROMISE.findall(text))):
        if promise not in project.promises:
            yield f"{path}: names promise {promise}, which {name} has not"
    for slide in sorted({number for numbers in SLIDE.findall(text) for number in numbers if number}):
        if slide not in project.slides:
            yield f"{path}: names slide {slide}, of which docs/design.md says nothing"
    for slide in sorted(set(OLD_SLIDE.findall(text))):
        yield f"{path}: says {slide} for a slide"
    if "DESIGN" in text:
        yield f"{path}: names DESIGN: the page is docs/design.md"
    for suite, case in sorted(set(TEST.findall(text))):
        if suite in project.suites and (suite, case) not in project.tests:
            yield f"{path}: names the test {suite}.{case}, which is not there"


def tables_of(text):
    """Header row -> rows, of each table of a page."""
    tables = {}
    for header, rows in re.findall(r"^(\|.*)\n\|[-| :]+\|\n((?:\|.*\n)*)", text, re.MULTILINE):
        tables[header] = rows.splitlines()
    return tables


def check_repeated_tables(project):
    """A table that two pages show is one table."""
    where = {}
    for path in project.files:
        if path == "README.md" or (path.startswith("docs/") and path.endswith(".md")):
            for header, rows in tables_of(project.read(path)).items():
                first, known = where.setdefault(header, (path, rows))
                if "`" in header and rows != known:
                    yield f"{path}: the table {header} is not as in {first}"


def check(root, files):
    project = Project(root, files)
    yield from check_repeated_tables(project)
    for path in files:
        if path.endswith(CODE + HASHED + DOCUMENT) and not path.startswith(NOT_READ):
            yield from check_file(project, path)


DESIGN = "# Design\n\n## 2. Light\n\n1. **Same bytes.** x\n\n| 24 | sectors |\n"
PLANTED = [
    ("a.h", "// As gone.cpp does.\n", "names gone.cpp"),
    ("a.h", "/* As\n * gone.h does. */\n", "names gone.h"),
    ("a.h", "// docs/design.md, section 9\n", "section 9"),
    ("a.h", "// docs/design.md, promise 7\n", "promise 7"),
    ("a.h", "// slide 99\n", "slide 99"),
    ("a.h", "// slides 24 and 25\n", "slide 25"),
    ("a.h", "// s24\n", "says s24"),
    ("a.py", "# DESIGN 2\n", "names DESIGN"),
    ("a.md", "Guarded by Farm.Forgets.\n", "names the test Farm.Forgets"),
]
TABLE = "| `role` | what |\n|---|---|\n| a | {} |\n"
SOUND = '// docs/design.md, section 2, promise 1 (slide 24); tests/farm_test.cpp: Farm.Keeps\nauto x = "gone.cpp // s24";\n'


def self_test():
    failures = 0
    for path, text, expected in [
        *PLANTED,
        ("docs/maps.md", TABLE.format("y"), "is not as in README.md"),
        ("docs/maps.md", TABLE.format("x"), None),
        ("a.h", '// docs/measurements.md, "Nothing"\n', "measurement Nothing"),
        ("a.h", SOUND, None),
    ]:
        with tempfile.TemporaryDirectory() as root:
            files = {
                "README.md": TABLE.format("x"),
                "docs/measurements.md": "## Speed\n",
                "docs/design.md": DESIGN,
                "tests/farm_test.cpp": "TEST(Farm, Keeps) {}\n",
                path: text,
            }
            for name, content in files.items():
                os.makedirs(os.path.join(root, os.path.dirname(name)), exist_ok=True)
                with open(os.path.join(root, name), "w", encoding="utf-8") as file:
                    file.write(content)
            found = list(check(root, list(files)))
        if (len(found) != 1 or expected not in found[0]) if expected else found:
            print(f"planted {text!r}: found {found}, expected {expected}")
            failures += 1
    print(f"{len(PLANTED) + 5 - failures} passed, {failures} failed")
    return failures == 0


def main():
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    if "--self-test" in sys.argv:
        sys.exit(0 if self_test() else 1)
    errors = list(check(root, tracked(root)))
    for error in errors:
        print(error)
    sys.exit(1 if errors else 0)


main()
