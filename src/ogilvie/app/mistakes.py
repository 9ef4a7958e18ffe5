"""Mistakes of a case file in plain words: path in the file, what was found, what is expected, what it may have meant."""

import re
from difflib import get_close_matches
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

_NUMBER = {
    "greater_than": (">", "gt"),
    "greater_than_equal": (">=", "ge"),
    "less_than": ("<", "lt"),
    "less_than_equal": ("<=", "le"),
}
_KIND = {
    "float_type": "a number",
    "float_parsing": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "string_type": 'a text in quotes ("...")',
    "bool_type": "true or false",
    "finite_number": "a finite number",
    "list_type": "a list [..., ...]",
    "tuple_type": "a list [..., ...]",
    "model_type": "a table of keys",
    "dict_type": "a table of keys",
    "string_too_short": "a text that is not empty",
}


def did_you_mean(word: str, allowed: list[str]) -> str:
    """Return ``; did you mean "x"?`` for a word close to one of those allowed, else nothing.

    Examples
    --------
    >>> did_you_mean("draft", ["draught", "panels"])
    '; did you mean "draught"?'
    """
    near = get_close_matches(word.lower(), allowed, n=1, cutoff=0.5)
    return f'; did you mean "{near[0]}"?' if near else ""


def unknown_key(path: str, key: str, allowed: list[str], what: str = "key") -> str:
    """Return the sentence for a key that is not known."""
    return f"{path}: unknown {what}{did_you_mean(key, allowed) or '.'} Allowed: {', '.join(allowed)}."


def describe(error: ValidationError, model: type[BaseModel], prefix: str) -> list[str]:
    """Return one sentence per mistake that pydantic found in a section."""
    found: dict[str, list[dict[str, Any]]] = {}
    for item in error.errors(include_url=False):
        found.setdefault(_path(model, item["loc"], prefix), []).append(dict(item))
    return [_sentence(path, items, model) for path, items in found.items()]


def _path(model: type[BaseModel], loc: tuple[int | str, ...], prefix: str) -> str:
    """Path in the file; the names that pydantic adds for the members of a union are left out."""
    path, here = prefix, model  # type: str, type[BaseModel] | None
    for part in loc:
        if isinstance(part, int):
            path += f"[{part}]"
        elif here is not None:
            path += f".{part}"
            here = _inner(here, part)
    return path


def _inner(model: type[BaseModel], key: str) -> type[BaseModel] | None:
    field = model.model_fields.get(key)
    return _model_in(field.annotation) if field else None


def _model_in(annotation: Any) -> type[BaseModel] | None:
    """The model inside an annotation such as ``list[Model] | None``."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((found for part in get_args(annotation) if (found := _model_in(part)) is not None), None)


def _sentence(path: str, items: list[dict[str, Any]], model: type[BaseModel]) -> str:
    first = items[0]
    if first["type"] == "extra_forbidden":
        owner = model
        for part in first["loc"][:-1]:
            owner = _inner(owner, str(part)) or owner
        return unknown_key(path, str(first["loc"][-1]), list(owner.model_fields))
    if first["type"] == "missing":
        return f"{path}: a number expected, the list ends before it." if path.endswith("]") else f"{path}: expected, not found."
    value = first["input"]
    wanted = " or ".join(dict.fromkeys(_wanted(item) for item in items))
    hint = ""
    if first["type"] == "literal_error" and isinstance(value, str):
        hint = did_you_mean(value, _words(first))
    return f"{path}: {_show(value)}: {wanted} expected{hint or '.'}"


def _words(item: dict[str, Any]) -> list[str]:
    return re.findall(r"'([^']*)'", item["ctx"]["expected"])


def _wanted(item: dict[str, Any]) -> str:
    kind, ctx = item["type"], item.get("ctx", {})
    if kind in _NUMBER:
        sign, key = _NUMBER[kind]
        return f"a number {sign} {ctx[key]:g}"
    if kind == "literal_error":
        words = [f'"{w}"' for w in _words(item)]
        return words[0] if len(words) == 1 else f"one of {', '.join(words)}"
    if kind in ("too_short", "too_long"):
        bound = ctx.get("min_length", ctx.get("max_length"))
        return f"{'at least' if kind == 'too_short' else 'at most'} {bound} entries"
    return _KIND.get(kind, item["msg"][:1].lower() + item["msg"][1:])


def _show(value: Any) -> str:
    """The value as it stands in the file, cut when it is long."""
    if isinstance(value, bool):
        return "true" if value else "false"
    text = f'"{value}"' if isinstance(value, str) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."
