"""A file's base colours as one stack of square pictures."""

from __future__ import annotations

import io

import numpy as np

from .gltf import CharacterError, Document, resource

LARGEST = 1024
"""The largest side of a picture that is kept [pixels]; larger ones are made smaller."""
MOST = 48
"""The most layers; further materials share the last."""


def pictures(document: Document) -> tuple[np.ndarray, np.ndarray]:
    """Layers (L, S, S, 4) uint8, sRGB and opacity, and the layer of each material (M + 1,).

    The last entry serves triangles without material. Layer -1: the file leaves the colour open
    (white and no picture, or marked so), and the figure's tint is taken.
    """
    entries, layers, which = document.list("materials"), [], []
    for entry in entries[:MOST]:
        colours = entry.get("pbrMetallicRoughness", {})
        factor = np.array(colours.get("baseColorFactor", (1, 1, 1, 1)), float)
        image = _image(document, colours["baseColorTexture"]["index"]) if "baseColorTexture" in colours else None
        tinted = entry.get("extras", {}).get("tint") if isinstance(entry.get("extras"), dict) else None
        if image is None and (tinted or np.all(factor[:3] > 0.999)):
            which.append(-1)
            continue
        which.append(len(layers))
        layers.append(_layer(image, factor, entry.get("alphaMode", "OPAQUE"), entry.get("alphaCutoff", 0.5)))
    which += which[-1:] * (len(entries) - len(which))
    size = max((len(layer) for layer in layers), default=1)
    stacked = [_resized(layer, size) for layer in layers] or [np.full((1, 1, 4), 255, np.uint8)]
    return np.stack(stacked), np.array([*which, -1])


def placed(document: Document, uv: np.ndarray, material: np.ndarray) -> np.ndarray:
    """Coordinates (V, 2) after the texture transforms of the materials (V,)."""
    uv = uv.astype(float).copy()
    for number, entry in enumerate(document.list("materials")):
        texture = entry.get("pbrMetallicRoughness", {}).get("baseColorTexture", {})
        change = texture.get("extensions", {}).get("KHR_texture_transform")
        if change:
            mine = material == number
            turn = change.get("rotation", 0.0)
            c, s = np.cos(turn), np.sin(turn)
            uv[mine] = (uv[mine] * change.get("scale", (1, 1))) @ np.array([[c, -s], [s, c]]) + change.get("offset", (0, 0))
    return uv


def two_sided(document: Document) -> bool:
    """Whether any material is seen from both sides."""
    return any(entry.get("doubleSided") for entry in document.list("materials"))


def _image(document: Document, texture: int):
    from PIL import Image

    source = document.json["textures"][texture].get("source")
    if source is None:
        return None  # only in a format of an extension: its factor has to do
    entry = document.json["images"][source]
    data = bytes(document.view(entry["bufferView"])) if "bufferView" in entry else resource(document.path, entry["uri"])
    try:
        with Image.open(io.BytesIO(data)) as image:
            image.thumbnail((LARGEST, LARGEST))
            return image.convert("RGBA")
    except (OSError, Image.DecompressionBombError) as error:
        raise CharacterError(f"{document.path}: picture {source} can't be read; export it as PNG or JPEG") from error


def _layer(image, factor: np.ndarray, mode: str, cutoff: float) -> np.ndarray:
    pixels = np.full((1, 1, 4), 255, np.uint8) if image is None else np.asarray(image)
    linear = (pixels[..., :3] / 255.0) ** 2.2 * np.clip(factor[:3], 0.0, 1.0)
    alpha = pixels[..., 3] / 255.0 * factor[3]
    seen = {"OPAQUE": np.ones_like(alpha), "MASK": (alpha >= cutoff).astype(float)}.get(mode, alpha)
    return np.round(np.concatenate([linear ** (1 / 2.2), seen[..., None]], -1) * 255).astype(np.uint8)


def _resized(layer: np.ndarray, size: int) -> np.ndarray:
    from PIL import Image

    if layer.shape[:2] == (1, 1):
        return np.broadcast_to(layer, (size, size, 4))
    return np.asarray(Image.fromarray(layer).resize((size, size)))
