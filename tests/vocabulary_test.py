#!/usr/bin/env python3
"""Holds the table of public types in docs/architecture.md to the public headers, both ways, and each public type to a
comment that says what it is.

usage: vocabulary_test.py ROOT        (prints a sentence for each difference; exit code 1 if there is one)
"""
import pathlib
import re
import sys

HEADING = "### Public types"
ENTRY = re.compile(r"\| \[[\w.]+\]\(\.\./include/tenebra/([\w.]+)\) \| (.*?) \| (.*?) \|")
DECLARATION = r"^(?:template\b.*\n)?\s*(?:struct|class|enum(?:\s+class)?|using)\s+(?:alignas\([^)]*\)\s*)?{}\b[^;]*?[{{=]"
TOKEN = re.compile(r"\b(?:struct|class|enum(?:\s+class)?)\s+(?:alignas\([^)]*\)\s*)?(\w+)[^;{()]*\{"
                   r"|\bnamespace\s+([\w:]*)\s*\{|\busing\s+(\w+)\s*=|\b(public|private|protected):|([{}])")


def without_comments(text):
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    return re.sub(r'//[^\n]*|"(?:[^"\\]|\\.)*"', "", text)


class Scope:
    """What a brace opens: a type, a namespace, or anything else (a body, an initialiser)."""

    def __init__(self, kind, name="", is_public=True):
        self.kind, self.name, self.is_public = kind, name, is_public


def public_types(text):
    """Names of the types that a header declares where a user may name them: in `tenebra` itself, or public in a
    public type ("Mesh::Shape")."""
    scopes, names = [], []

    def is_open():
        return [s.name for s in scopes if s.kind == "namespace"] == ["tenebra"] and \
            all(s.kind != "body" and s.is_public for s in scopes)

    def full(name):
        return "::".join([s.name for s in scopes if s.kind == "type"] + [name])

    for match in TOKEN.finditer(without_comments(text)):
        type_name, namespace, alias, access, brace = match.groups()
        if type_name:
            if is_open():
                names.append(full(type_name))
            scopes.append(Scope("type", type_name, not match.group().startswith("class")))
        elif namespace is not None:
            scopes.append(Scope("namespace", namespace))
        elif alias:
            if is_open():
                names.append(full(alias))
        elif access:
            scopes[-1].is_public = access == "public"
        elif brace == "{":
            scopes.append(Scope("body"))
        else:
            scopes.pop()
    return names


def entries(page):
    """(type, header, what the header is about) of each type in the rows below the heading, up to the next heading."""
    table = page.split(HEADING, 1)[1].split("\n#", 1)[0]
    return [(name, header, what) for header, what, types in ENTRY.findall(table) for name in re.findall(r"`([\w:]+)`", types)]


def is_explained(name, text):
    """Whether `///` stands above the type's declaration, or `///<` behind it."""
    for found in re.finditer(DECLARATION.format(name.split("::")[-1]), text, flags=re.M):
        above = text[:found.start()].rstrip("\n").rpartition("\n")[2].strip()
        behind = text[found.start():].lstrip("\n").partition("\n")[0]
        if above.startswith("///") or "///<" in behind:
            return True
    return False


def differences(root):
    texts = {header.name: header.read_text(encoding="utf-8") for header in sorted((root / "include/tenebra").glob("*.h"))}
    declared = {(name, header) for header, text in texts.items() for name in public_types(text)}
    page = (root / "docs/architecture.md").read_text(encoding="utf-8")
    if HEADING not in page:
        yield f"docs/architecture.md: found no heading '{HEADING}', expected the table of public types below it"
        return
    listed = entries(page)
    named = [(name, header) for name, header, _ in listed]
    for name, header in sorted(declared - set(named)):
        yield f"include/tenebra/{header}: {name} has no entry in docs/architecture.md, expected one in the header's row under Public types"
    for name, header in sorted(set(named) - declared):
        yield f"docs/architecture.md: found an entry for {name}, which include/tenebra/{header} does not declare"
    for name, header in sorted({entry for entry in named if named.count(entry) > 1}):
        yield f"docs/architecture.md: found several entries for {name} of {header}, expected one"
    for header in sorted({header for _, header, what in listed if not what.strip()}):
        yield f"docs/architecture.md: the row of {header} does not say what it is about"
    for name, header in sorted(declared):
        if not is_explained(name, texts[header]):
            yield f"include/tenebra/{header}: {name} has no comment (///), expected one that says what it is"
    if not declared:
        yield "include/tenebra: found no type at all, expected the public ones: is this the root of the project?"


def check_itself():
    """The little parser knows what it will meet."""
    text = """namespace tenebra {
      namespace points { struct Hidden; struct Other { int a{0}; }; }
      enum class Kind { a, b };  struct Outer { struct Inner { int x{1}; }; int f() { return 0; } private: struct No {}; };
      class Box { struct State; public: struct Seen {}; private: struct State2 { }; };
      using Alias = int;  // struct Comment {};
      template <class T> using Maybe = T;
      inline void f(struct Outer) { using Local = int; struct Local2 {}; } }"""
    expected = ["Kind", "Outer", "Outer::Inner", "Box", "Box::Seen", "Alias", "Maybe"]
    found = public_types(text)
    assert found == expected, f"found {found}, expected {expected}"
    explained = "/// What it is.\nstruct A {};\nenum class B { a };  ///< what it is\n// No.\nstruct C {};\nclass D;\n"
    assert [is_explained(name, explained) for name in "ABCD"] == [True, True, False, False]


def main():
    check_itself()
    found = list(differences(pathlib.Path(sys.argv[1])))
    print("\n".join(found) or "every public type has its entry")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
