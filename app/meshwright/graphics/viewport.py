"""The viewport: the map between the plane of the mesh and pixels of a picture or window.

The camera looks down the z axis in parallel projection, with x to the right and y up. Screen
coordinates are pixels from the upper left corner.
"""

from dataclasses import dataclass, replace

import numpy as np

NEAREST = 1e-9
FARTHEST = 1e12


@dataclass(frozen=True)
class Viewport:
    """Centre of the view in the plane, pixels per unit of length, size in pixels."""

    centre: tuple[float, float] = (0.0, 0.0)
    pixels: float = 100.0
    size: tuple[int, int] = (800, 600)

    @property
    def parallel_scale(self) -> float:
        """Half the height of the view in units of length, the parallel scale of a VTK camera."""
        return self.size[1] / (2.0 * self.pixels)

    @property
    def tolerance(self) -> float:
        """Units of length by which a drawn line may be away from its curve: a tenth of a pixel."""
        return 0.1 / self.pixels

    def to_screen(self, points: np.ndarray) -> np.ndarray:
        """Pixels (n, 2) of ``points`` (n, 2 or 3)."""
        points = np.asarray(points, dtype=float)
        offset = (points[..., :2] - self.centre) * (self.pixels, -self.pixels)
        return offset + (self.size[0] / 2.0, self.size[1] / 2.0)

    def to_plane(self, x: float, y: float) -> tuple[float, float]:
        """The point of the plane at pixel (x, y)."""
        return (
            self.centre[0] + (x - self.size[0] / 2.0) / self.pixels,
            self.centre[1] - (y - self.size[1] / 2.0) / self.pixels,
        )

    def zoomed(self, factor: float, x: float, y: float) -> "Viewport":
        """Zoomed by ``factor``; the point at pixel (x, y) stays there."""
        pixels = float(np.clip(self.pixels * factor, NEAREST, FARTHEST))
        px, py = self.to_plane(x, y)
        centre = (
            px - (x - self.size[0] / 2.0) / pixels,
            py + (y - self.size[1] / 2.0) / pixels,
        )
        return replace(self, centre=centre, pixels=pixels)

    def panned(self, dx: float, dy: float) -> "Viewport":
        """The picture moved by (dx, dy) pixels."""
        centre = (self.centre[0] - dx / self.pixels, self.centre[1] + dy / self.pixels)
        return replace(self, centre=centre)

    def resized(self, width: int, height: int) -> "Viewport":
        """Another size in pixels, with the same centre and scale."""
        return replace(self, size=(max(width, 1), max(height, 1)))

    def fitted(
        self, points: np.ndarray, margin: float = 48.0, below: float | None = None
    ) -> "Viewport":
        """The viewport that shows all ``points`` (n, 2 or 3) with a margin of ``margin`` pixels;
        ``below``: of so many pixels under them.
        """
        points = np.asarray(points, dtype=float)
        if len(points) == 0:
            return replace(self, centre=(0.0, 0.0), pixels=100.0)
        low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        extent = np.maximum(high - low, 1e-12 + 1e-9 * np.abs(high).max())
        below = margin if below is None else below
        taken = (2.0 * margin, margin + below)
        room = np.maximum(np.array(self.size, dtype=float) - taken, 16.0)
        centre = (float(low[0] + high[0]) / 2.0, float(low[1] + high[1]) / 2.0)
        pixels = float(np.clip((room / extent).min(), NEAREST, FARTHEST))
        return replace(self, centre=centre, pixels=pixels).panned(0.0, 0.5 * (margin - below))

    def around(self, points: np.ndarray, least: float = 72.0) -> "Viewport":
        """The viewport centred on ``points`` (n, 2 or 3), zoomed in until they are ``least`` pixels
        wide or high; if they are larger already and fit, the scale stays.
        """
        points = np.asarray(points, dtype=float)
        low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        extent = max(float((high - low).max()), 1e-12 + 1e-9 * float(np.abs(high).max()))
        room = 0.8 * min(self.size)
        pixels = min(max(self.pixels, least / extent), max(room, least) / extent)
        centre = (float(low[0] + high[0]) / 2.0, float(low[1] + high[1]) / 2.0)
        return replace(self, centre=centre, pixels=float(np.clip(pixels, NEAREST, FARTHEST)))
