"""Pictures of the page that tests compare with kept ones, in a quarter of their size.

At that size text is gray, so another rendering of it changes little, while a panel that moved changes many places:
`share` says how many. Letters are those of a font that Pillow contains, so that lines break alike on all machines.
"""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageFilter, ImageFont

SHRINK = 4
BLOCK = 8
"""Places that are compared are squares of so many pixels of the small pictures."""
NOTICED = 10.0
"""Mean difference of a place, of 255, that counts."""
MOST = 0.01
"""Largest share of places that may differ. A panel that moved by 24 pixels changes more: tests prove it."""
STEP = 8
"""Between the brightnesses of a kept picture, so that it is small."""


def shrunk(png: bytes | Path) -> Image.Image:
    """A picture in a quarter of its size."""
    image = Image.open(io.BytesIO(png) if isinstance(png, bytes) else png).convert("RGB")
    return image.resize((round(image.width / SHRINK), round(image.height / SHRINK)), Image.Resampling.BOX)


def differences(one: Image.Image, other: Image.Image) -> npt.NDArray[np.float64]:
    """How much each place differs, 0 to 255."""
    soft = [np.asarray(image.filter(ImageFilter.BoxBlur(1))).astype(float) for image in (one, other)]
    each = np.abs(soft[0] - soft[1]).max(axis=2)
    rows, columns = (-(-length // BLOCK) for length in each.shape)
    padded = np.pad(each, ((0, rows * BLOCK - each.shape[0]), (0, columns * BLOCK - each.shape[1])), mode="edge")
    means: npt.NDArray[np.float64] = padded.reshape(rows, BLOCK, columns, BLOCK).mean(axis=(1, 3))
    return means


def share(one: Image.Image, other: Image.Image) -> float:
    """The share of places that differ noticeably, 0 to 1; 1 for pictures of different sizes."""
    if one.size != other.size:
        return 1.0
    return float((differences(one, other) > NOTICED).mean())


def marked(one: Image.Image, other: Image.Image) -> Image.Image:
    """The second picture, pale, with the places that differ in red."""
    places = differences(one, other) > NOTICED
    mask = Image.fromarray(places.repeat(BLOCK, axis=0).repeat(BLOCK, axis=1)[: one.height, : one.width])
    pale = Image.blend(other, Image.new("RGB", other.size, "white"), 0.6)
    pale.paste(Image.blend(other, Image.new("RGB", other.size, "red"), 0.5), mask=mask)
    return pale


@dataclass(frozen=True)
class Snapshots:
    """The kept pictures, and where to write what differs from them."""

    folder: Path
    found: Path
    update: bool = False

    def check(self, name: str, png: bytes) -> None:
        """Compare a picture of the page with the kept one, or keep it."""
        kept, now = self.folder / f"{name}.png", shrunk(png)
        if self.update:
            self.folder.mkdir(parents=True, exist_ok=True)
            if not kept.exists() or share(shrunk_already(kept), now) > MOST / 2:
                now.point(lambda value: min(255, (value + STEP // 2) // STEP * STEP)).save(kept, optimize=True)
            return
        assert kept.exists(), f"no picture is kept as {kept}: run pytest with --update-snapshots and look at it"
        before = shrunk_already(kept)
        found = share(before, now)
        if found <= MOST:
            return
        self.found.mkdir(parents=True, exist_ok=True)
        (self.found / f"{name}.png").write_bytes(png)
        if before.size == now.size:
            marked(before, now).resize((now.width * SHRINK, now.height * SHRINK), Image.Resampling.NEAREST).save(
                self.found / f"{name}-differences.png"
            )
        raise AssertionError(
            f"{100 * found:.1f} % of the page looks different from {kept}, at most {100 * MOST:.0f} % may:"
            f" see {self.found}; if it is meant to, run pytest with --update-snapshots"
        )


def shrunk_already(path: Path) -> Image.Image:
    """A kept picture."""
    return Image.open(path).convert("RGB")


def letters() -> ImageFont.FreeTypeFont:
    """The font of the pictures."""
    font = ImageFont.load_default(15)
    assert isinstance(font, ImageFont.FreeTypeFont), "Pillow has no FreeType"
    return font


def font_script() -> str:
    """A script for the page that shows all text in `letters`."""
    data = base64.b64encode(letters().font_bytes).decode()
    return f"""(() => {{
        const bytes = Uint8Array.from(atob("{data}"), (one) => one.charCodeAt(0));
        document.fonts.add(new FontFace("Kept", bytes));
        const sheet = new CSSStyleSheet();
        sheet.replaceSync("*, ::before, ::after {{ font-family: Kept, sans-serif !important; }}");
        document.adoptedStyleSheets = [sheet];
    }})()"""
