#pragma once

#include <string_view>

#include "fleetmap/eval/picture.hpp"

/// The font is ours rather than libcairo's text. Cairo would replace the font, draw_text() and the PNG
/// writer, about 110 lines; legend, bars and the renderer of the points stay. It brings fontconfig, FreeType,
/// pixman and the X11 libraries, needs an installed font, and pictures would differ with that font.
namespace fleetmap::eval {

/// Pixels that `text` takes at `scale` pixels a dot of the 5 x 7 font.
int text_width(std::string_view text, int scale);
inline int text_height(int scale) { return 7 * scale; }
/// Draws ASCII text with its upper left corner at (x, y), clipped to the image; other bytes as '?'.
void draw_text(Image& image, int x, int y, std::string_view text, Rgb colour, int scale);
void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour);

/// Title, legend, colour bar and, when `metres_per_pixel` is positive, scale bar of a view.
void annotate(Image& image, const View& view, double metres_per_pixel);

}  // namespace fleetmap::eval
