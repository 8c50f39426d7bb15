"""Takes pictures of the window in many states, which real mouse and key events bring about.

    python docs/make_contact_sheet.py [FOLDER [STATE ...]]

writes one PNG a state into FOLDER (build/contact-sheet if none is named), and contact-sheet.png
with all of them; pictures that README shows go to docs/images. A display of at least 1920x1080
pixels is needed: ``xvfb-run -s "-screen 0 1920x1200x24" python docs/make_contact_sheet.py``.
No settings of the user are read or written.
"""

import sys
from pathlib import Path

from contact_scenes import SCENES
from PIL import Image, ImageDraw
from qtpy.QtWidgets import QApplication

from meshwright.desktop.main_window.startup import application
from meshwright_core import warm_up

IMAGES = Path(__file__).parent / "images"
IN_README = {
    "hover": "window.png",
    "agent": "agent.png",
    "history": "history.png",
    "new-mesh": "new-mesh.png",
}
COLUMNS, THUMB = 4, 640


def main(folder: Path, names: list[str]) -> None:
    """Make all pictures or those named, then the sheet."""
    folder.mkdir(parents=True, exist_ok=True)
    application()
    warm_up.warm()
    QApplication.setQuitOnLastWindowClosed(False)
    sheet = []
    for name, (caption, play) in SCENES.items():
        if names and name not in names:
            continue
        image = play()
        image.save(folder / f"{name}.png")
        if name in IN_README:
            image.save(IMAGES / IN_README[name], optimize=True)
        sheet.append((caption, image))
        sys.stderr.write(f"{name}\n")
    put_together(sheet).save(folder / "contact-sheet.png", optimize=True)


def put_together(sheet: list[tuple[str, Image.Image]]) -> Image.Image:
    """All pictures in rows of :data:`COLUMNS`, each over its caption."""
    height, gap, line = THUMB * 5 // 8, 24, 34
    rows = -(-len(sheet) // COLUMNS)
    whole = Image.new(
        "RGB",
        (gap + COLUMNS * (THUMB + gap), gap + rows * (height + line + gap)),
        "#ffffff",
    )
    draw = ImageDraw.Draw(whole)
    for number, (caption, image) in enumerate(sheet):
        x = gap + number % COLUMNS * (THUMB + gap)
        y = gap + number // COLUMNS * (height + line + gap)
        small = image.copy()
        small.thumbnail((THUMB, height), Image.Resampling.LANCZOS)
        whole.paste(small, (x + (THUMB - small.width) // 2, y + (height - small.height) // 2))
        draw.text((x, y + height + 8), caption, "#1e2329", font_size=18)
    return whole


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "build/contact-sheet"), sys.argv[2:])
