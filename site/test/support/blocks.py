"""Makes blocks.ttf: a font in which every character is a block, about as wide and high as a letter.

Words set in it take up the same space on every machine, whatever fonts there are. It
needs fontTools, and is run only to change the font: python3 blocks.py, here
"""

from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib.tables._c_m_a_p import CmapSubtable

# Width and height of the blocks, in thousandths of the size of the type. The first stands for what
# is missing, for which browsers take another font: nothing is.
GLYPHS = {".notdef": (560, 680), "other": (560, 680), "space": (270, 0), "narrow": (290, 500), "lower": (530, 500), "upper": (650, 690)}


def glyph_of(code: int) -> str:
    character = chr(code)
    if character.isspace():
        return "space"
    if character in "fijlrt.,:;!'|()[]{}’‘":
        return "narrow"
    if character.islower():
        return "lower"
    return "upper" if character.isupper() else "other"


def block(width: int, height: int):
    pen = TTGlyphPen(None)
    if height > 0:
        pen.moveTo((40, 0))
        pen.lineTo((40, height))
        pen.lineTo((width - 40, height))
        pen.lineTo((width - 40, 0))
        pen.closePath()
    return pen.glyph()


font = FontBuilder(1000, isTTF=True)
font.setupGlyphOrder(list(GLYPHS))
font.setupCharacterMap({code: glyph_of(code) for code in range(32, 127)})
font.setupGlyf({name: block(*size) for name, size in GLYPHS.items()})
font.setupHorizontalMetrics({name: (width, 40 if height else 0) for name, (width, height) in GLYPHS.items()})
font.setupHorizontalHeader(ascent=900, descent=-250)
font.setupOS2(sTypoAscender=900, sTypoDescender=-250, usWinAscent=900, usWinDescent=250, sxHeight=500, sCapHeight=690)
font.setupNameTable({"familyName": "Blocks", "styleName": "Regular"})
font.setupPost()

# Every other character, too: many to one.
many = CmapSubtable.newSubtable(13)
many.platformID, many.platEncID, many.language = 3, 10, 0
codes = [*range(32, 0xD800), *range(0xE000, 0xFFFE), *range(0x1F000, 0x1FB00)]
many.cmap = {code: glyph_of(code) if code < 0x250 else "other" for code in codes}
font.font["cmap"].tables.append(many)
font.save("blocks.ttf")
