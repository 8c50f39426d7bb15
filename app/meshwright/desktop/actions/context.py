"""The objects that actions call: document, assistant and controllers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from meshwright.assistant.assistant import Assistant
from meshwright.desktop.agent.agent_controller import AgentController
from meshwright.desktop.agent.hints_controller import HintsController
from meshwright.desktop.application.preferences_controller import PreferencesController
from meshwright.desktop.application.readiness import Readiness
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.blocks.blocks_controller import BlocksController
from meshwright.desktop.blocks.export_blocks_controller import ExportBlocksController
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.editing.cleanable_lines_controller import CleanableLinesController
from meshwright.desktop.editing.edit_controller import EditController
from meshwright.desktop.editing.hover_controller import HoverController
from meshwright.desktop.editing.keyboard_navigation import KeyboardNavigation
from meshwright.desktop.editing.names_controller import NamesController
from meshwright.desktop.editing.selection_controller import SelectionController
from meshwright.desktop.editing.vertex_commands import VertexCommands
from meshwright.desktop.files.file_controller import FileController
from meshwright.desktop.help.help_controller import HelpController
from meshwright.desktop.history.playback_controller import PlaybackController
from meshwright.desktop.levels.level_controller import LevelController
from meshwright.desktop.quality.colour_controller import ColourController
from meshwright.desktop.quality.quality_controller import QualityController
from meshwright.document.document import Document


@dataclass(frozen=True)
class ActionContext:
    """Document, assistant and controllers of one window; ``open_menus()`` opens the first of its
    menus, ``close()`` closes it.
    """

    document: Document
    assistant: Assistant
    settings: Settings
    readiness: Readiness
    canvas: Canvas
    files: FileController
    playback: PlaybackController
    levels: LevelController
    hover: HoverController
    editing: EditController
    lines: CleanableLinesController
    quality: QualityController
    colours: ColourController
    selection_tools: SelectionController
    names: NamesController
    blocks: BlocksController
    block_export: ExportBlocksController
    navigation: KeyboardNavigation
    vertices: VertexCommands
    hints: HintsController
    agent: AgentController
    preferences: PreferencesController
    help: HelpController
    open_menus: Callable[[], None]
    close: Callable[[], bool]
