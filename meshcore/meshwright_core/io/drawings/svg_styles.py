"""The cascade of styles in SVG: style sheets, style attributes, presentation attributes.

Selectors are matched by cssselect2 and parsed by tinycss2, so that ids, classes, elements,
attributes, lists of selectors, descendants and specificity mean what they mean in a browser.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any
from xml.etree import ElementTree

from meshwright_core.io.drawings.svg_lengths import tag_of

READ = ("display", "visibility", "fill", "stroke", "transform")
"""The properties that are looked at."""
_PRINT = re.compile(r"^\s*(?:only\s+)?print\b", re.IGNORECASE)

Declared = dict[str, tuple[bool, str]]
"""Values by property, each with whether it is marked as important."""


class Styles:
    """The styles of all elements of a drawing."""

    def __init__(self, root: ElementTree.Element) -> None:
        """Parse the style sheets; `root` and what it holds stays as it is afterwards."""
        self.by_element: dict[int, list[tuple[Any, Declared]]] = {}
        sheets = [e.text or "" for e in root.iter() if tag_of(e) == "style"]
        if not any(sheet.strip() for sheet in sheets):
            return
        import cssselect2

        matcher = cssselect2.Matcher()
        for sheet in sheets:
            for prelude, declared in _rules(sheet):
                try:
                    selectors = cssselect2.compile_selector_list(prelude)
                except cssselect2.SelectorError:
                    continue  # as in a browser: the rule is dropped
                for selector in selectors:
                    if selector.pseudo_element is None:
                        matcher.add_selector(selector, declared)
        for wrapped in cssselect2.ElementWrapper.from_xml_root(root).iter_subtree():
            found = matcher.match(wrapped)
            if found:
                # specificity, then order: later ones overrule
                ranked = sorted(found, key=lambda match: (match[0], match[1]))
                self.by_element[id(wrapped.etree_element)] = [
                    (match[0], match[3]) for match in ranked
                ]

    def of(self, element: ElementTree.Element) -> dict[str, str]:
        """Return the values that the cascade gives an element for the properties in `READ`."""
        values = {
            name: (False, text.strip().lower() if name != "transform" else text)
            for name in READ
            if (text := element.get(name)) is not None
        }
        for _, declared in self.by_element.get(id(element), ()):
            _overrule(values, declared)
        inline = element.get("style", "")
        if inline.strip():
            _overrule(values, _declared(_parsed(inline)))
        return {name: value for name, (_, value) in values.items()}


def _overrule(values: Declared, declared: Declared) -> None:
    for name, (important, value) in declared.items():
        if important or not values.get(name, (False, ""))[0]:
            values[name] = (important, value)


def _rules(sheet: str) -> Iterator[tuple[list[Any], Declared]]:
    """Yield the preludes and declarations of the rules of a style sheet, @media among them."""
    import tinycss2

    pending = tinycss2.parse_stylesheet(sheet, skip_comments=True, skip_whitespace=True)
    while pending:
        rule = pending.pop(0)
        if rule.type == "qualified-rule":
            yield rule.prelude, _declared(tinycss2.parse_blocks_contents(rule.content))
        elif _is_for_screens(rule):
            inner = tinycss2.parse_rule_list(rule.content, skip_comments=True, skip_whitespace=True)
            pending = [*inner, *pending]


def _is_for_screens(rule: Any) -> bool:
    """Whether a rule is a group of others that counts where things are not printed."""
    import tinycss2

    if rule.type != "at-rule" or rule.lower_at_keyword != "media" or not rule.content:
        return False
    return _PRINT.match(tinycss2.serialize(rule.prelude)) is None


def _parsed(text: str) -> list[Any]:
    import tinycss2

    found: list[Any] = tinycss2.parse_blocks_contents(text)
    return found


def _declared(nodes: Iterable[Any]) -> Declared:
    import tinycss2

    found: Declared = {}
    for node in nodes:
        if node.type != "declaration" or node.lower_name not in READ:
            continue
        value = tinycss2.serialize(node.value).strip()
        if node.lower_name != "transform":
            value = value.lower()
        _overrule(found, {node.lower_name: (bool(node.important), value)})
    return found
