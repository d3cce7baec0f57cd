#!/usr/bin/env python3
"""How the code must look, as far as a program can tell.

  style.py          clang-format, black and shellcheck agree with every file; a line of the product carries one thought;
                    long files are few and say why
  style.py --fix    formats everything instead
  style.py --list   tokens per line and lines of each product file

A token is a word, a number, a literal or one character of punctuation; a code line is one that is more than blank or
comment. For comparison, counted the same way: leveldb has 7.0, and 4 % of its files are longer than 800 lines.
"""
import argparse
import re
import subprocess
import sys

MAX_TOKENS_PER_LINE = 9.5
MAX_LINES, MAX_LONG_FILES = 250, 6
# Such a file says why, in its first comment.
REASON = "Long because"

COMMENT_OR_LITERAL = re.compile(
    r"""//[^\n]*|/\*.*?\*/|("(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')""", flags=re.DOTALL
)
TOKEN = re.compile(r"""("(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|[A-Za-z_]\w*|[\d.][\w.']*|[^\s\w])""")


def tracked(*patterns):
    listed = subprocess.run(["git", "ls-files", *patterns], check=True, capture_output=True, text=True).stdout
    return listed.split()


def tokens_and_lines(text):
    code = COMMENT_OR_LITERAL.sub(lambda match: match.group(1) or "\n" * match.group(0).count("\n"), text)
    return len(TOKEN.findall(code)), sum(1 for line in code.split("\n") if line.strip())


def product_texts():
    for name in tracked("*.h", "*.cpp"):
        if not name.startswith("tests/"):
            with open(name, encoding="utf-8") as file:
                yield name, file.read()


def density_problems():
    tokens = lines = 0
    for _, text in product_texts():
        of_file = tokens_and_lines(text)
        tokens, lines = tokens + of_file[0], lines + of_file[1]
    if tokens <= MAX_TOKENS_PER_LINE * lines:
        return []
    return [f"the product has {tokens / lines:.2f} tokens a code line, more than {MAX_TOKENS_PER_LINE}"]


def length_problems():
    long_files = {name: text for name, text in product_texts() if text.count("\n") > MAX_LINES}
    problems = [
        f"{name} has {text.count(chr(10))} lines, and does not say why ('{REASON} ...' at its top)"
        for name, text in long_files.items()
        if REASON not in text[:1000]
    ]
    if len(long_files) > MAX_LONG_FILES:
        problems.append(
            f"{len(long_files)} files are longer than {MAX_LINES} lines, more than {MAX_LONG_FILES}"
        )
    return problems


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--fix", action="store_true")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    if options.list:
        for name, text in product_texts():
            tokens, lines = tokens_and_lines(text)
            print(f"{tokens / max(lines, 1):6.2f} {text.count(chr(10)):5d} {name}")
        return 0
    cpp = [
        "clang-format-14",
        *(["-i"] if options.fix else ["--dry-run", "--Werror"]),
        *tracked("*.h", "*.cpp"),
    ]
    python = [
        "black",
        "--quiet",
        "--line-length",
        "110",
        *([] if options.fix else ["--check"]),
        *tracked("*.py"),
    ]
    shell = ["shellcheck", *tracked("*.sh", ".ci/run")]
    problems = [
        f"{command[0]} is not content"
        for command in (cpp, python, shell)
        if subprocess.run(command).returncode != 0
    ]
    if not options.fix:
        problems += density_problems() + length_problems()
    for problem in problems:
        print(f"style.py: {problem}", file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
