"""The twenty parts of the block benchmark."""

from meshwright_core.domains.block_parts import TUTORIAL_BLOCKS, block_parts


def test_there_are_twenty_sound_parts_with_named_sides():
    parts = block_parts()
    assert len(parts) == 20
    assert list(parts)[:5] == list(TUTORIAL_BLOCKS)
    assert all(domain.area > 0.0 and domain.name == name for name, domain in parts.items())
    named = {piece.name for piece in parts["nozzle"].sides.all_sides[0].pieces}
    assert named == {"axis", "outlet", "wall", "inlet"}
    for name in ("two layers", "inlay"):
        assert len(parts[name].sides.region_names) == 2
