#include "map_sheet.h"

#include "sheet_words.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

namespace drtv::image {
namespace {

constexpr Colour paper = {18, 20, 24};
constexpr Colour ink = {222, 224, 228};
constexpr Colour faint_ink = {140, 144, 150};

// Pixels of a text's pixel.
constexpr int min_scale = 2;
constexpr int max_scale = 6;

class Sheet {
  public:
    Sheet(const Image& map, const MapExtent& extent, const SheetText& text, int scale)
        : map_(map), extent_(extent), text_(text), scale_(scale), line_(12 * scale_) {
        const int map_width = static_cast<int>(map.width);
        const int map_height = static_cast<int>(map.height);
        const int labels_left = widest({metres_of(extent.j0), metres_of(extent.j1)}) + 3 * gap();
        const int labels_right = widest({number(extent.j0), number(extent.j1)}) + 2 * gap();
        const int width = std::max(labels_left + map_width + labels_right, static_cast<int>(min_sheet_side));
        left_ = labels_left + (width - labels_left - map_width - labels_right) / 2;
        lines_ = wrapped(text.title, width - 2 * gap(), scale_);
        top_ = gap() + static_cast<int>(lines_.size()) * line_ + line_;
        lay_out_legend(width);
        const int foot = line_ + 2 * gap() + scale_bar_height() + legend_height_ + gap();
        const int height = std::max(top_ + map_height + foot, static_cast<int>(min_sheet_side));
        width_ = width;
        height_ = height;
    }

    [[nodiscard]] bool fits() const { return std::max(width_, height_) <= static_cast<int>(max_sheet_side); }

    MapSheet draw() {
        image_ = Image(static_cast<std::size_t>(width_), static_cast<std::size_t>(height_));
        fill(image_, {0, 0, width_, height_}, paper);
        for (std::size_t n = 0; n < lines_.size(); ++n)
            write(gap(), gap() + static_cast<int>(n) * line_, lines_[n], ink);
        for (std::size_t y = 0; y < map_.height; ++y) {
            std::copy_n(map_.at(0, y),
                        3 * map_.width,
                        image_.at(static_cast<std::size_t>(left_), static_cast<std::size_t>(top_) + y));
        }
        frame(image_, {left_ - 1, top_ - 1, right() + 1, bottom() + 1}, faint_ink);
        write_columns();
        write_rows();
        const int y = bottom() + line_ + 2 * gap();
        draw_scale_bar(y);
        draw_north(y);
        draw_legend(y + scale_bar_height());
        const std::string map =
            number(left_) + "," + number(top_) + "," + number(right()) + "," + number(bottom());
        return {std::move(image_), {{world_rectangle_key, world()}, {map_rectangle_key, map}}};
    }

  private:
    [[nodiscard]] int gap() const { return 4 * scale_; }
    [[nodiscard]] int right() const { return left_ + static_cast<int>(map_.width); }
    [[nodiscard]] int bottom() const { return top_ + static_cast<int>(map_.height); }
    [[nodiscard]] int scale_bar_height() const { return 2 * line_ + gap(); }
    [[nodiscard]] double sector_px() const { return sector_size_m / extent_.metres_per_pixel; }

    static std::string number(int n) { return std::to_string(n); }
    static std::string metres_of(int sector) { return number(sector * sector_size_m); }

    [[nodiscard]] int widest(std::initializer_list<std::string> texts) const {
        int widest = 0;
        for (const std::string& text : texts)
            widest = std::max(widest, text_width(text, scale_));
        return widest;
    }

    void write(int x, int y, std::string_view text, const Colour& colour) {
        write_text(image_, x, y, text, colour, scale_);
    }
    void write_centred(int x, int y, std::string_view text, const Colour& colour) {
        write(x - text_width(text, scale_) / 2, y, text, colour);
    }

    // Of the sectors first to last - 1 those whose number is a multiple of the step; the first, where none
    // is.
    template <class Visit>
    static void visit_labelled(int first, int last, int step, Visit visit) {
        const int multiple = first + ((step - first % step) % step);
        for (int n = multiple < last ? multiple : first; n < last; n += step)
            visit(n);
    }

    void write_columns() {
        const int number_step =
            label_step(sector_px(), widest({number(extent_.i0), number(extent_.i1)}) + gap());
        visit_labelled(extent_.i0, extent_.i1, number_step, [&](int i) {
            const double middle = extent_.x_px((i + 0.5) * sector_size_m);
            write_centred(left_ + static_cast<int>(middle), top_ - line_ + gap() / 2, number(i), faint_ink);
        });
        const int metre_step =
            label_step(sector_px(), widest({metres_of(extent_.i0), metres_of(extent_.i1)}) + 2 * gap());
        visit_labelled(extent_.i0, extent_.i1 + 1, metre_step, [&](int i) {
            const int x = left_ + static_cast<int>(extent_.x_px(i * sector_size_m));
            fill(image_, {x, bottom(), x + scale_ / 2, bottom() + gap()}, ink);
            write_centred(x, bottom() + gap() + scale_, metres_of(i), ink);
        });
    }

    void write_rows() {
        const int step = label_step(sector_px(), line_);
        visit_labelled(extent_.j0, extent_.j1, step, [&](int j) {
            const double middle = extent_.y_px((j + 0.5) * sector_size_m);
            const int y = top_ + static_cast<int>(middle) - 4 * scale_;
            write(right() + gap(), y, number(j), faint_ink);
        });
        visit_labelled(extent_.j0, extent_.j1 + 1, step, [&](int j) {
            const int y = top_ + static_cast<int>(extent_.y_px(j * sector_size_m));
            fill(image_, {left_ - gap(), y, left_, y + scale_ / 2}, ink);
            const std::string text = metres_of(j);
            write(left_ - 2 * gap() - text_width(text, scale_), y - 4 * scale_, text, ink);
        });
    }

    void draw_scale_bar(int y) {
        const double metres = round_down(0.25 * width_ * extent_.metres_per_pixel);
        const int length = std::max(1, static_cast<int>(metres / extent_.metres_per_pixel));
        const int x = gap();
        const int thick = 4 * scale_;
        fill(image_, {x, y, x + length, y + thick}, ink);
        fill(image_, {x + scale_, y + scale_, x + length / 2, y + thick - scale_}, paper);
        write(x, y + thick + 2 * scale_, length_text(metres), ink);
        const std::string axes = "axes in metres; sectors of 64 m, i above, j on the right";
        const int beside = x + std::max(length, text_width(length_text(metres), scale_)) + 4 * gap();
        if (beside + text_width(axes, scale_) < width_ - 6 * gap())
            write(beside, y, axes, faint_ink);
    }

    // An arrow that points up, and its letter.
    void draw_north(int y) {
        const int x = width_ - 4 * gap();
        const int head = 10 * scale_;
        for (int row = 0; row < head; ++row)
            fill(image_, {x - row / 2, y + row, x + row / 2 + 1, y + row + 1}, ink);
        write_centred(x, y + head + 2 * scale_, "N", ink);
    }

    struct Placed {
        int x;
        int row;
        std::vector<std::string> lines;
    };

    [[nodiscard]] int swatch() const { return 7 * scale_; }

    void lay_out_legend(int width) {
        const int room = width - 3 * gap() - swatch();
        int x = gap();
        int row = 0;
        for (const LegendEntry& entry : text_.legend) {
            std::vector<std::string> lines = wrapped(entry.text, room, scale_);
            const int needed = swatch() + gap() + text_width(entry.text, scale_);
            if (x > gap() && x + needed > width - gap()) {
                x = gap();
                ++row;
            }
            const int more_rows = static_cast<int>(lines.size()) - 1;
            legend_.push_back({x, row, std::move(lines)});
            row += more_rows;
            x += needed + 3 * gap();
        }
        legend_height_ = text_.legend.empty() ? 0 : (row + 1) * line_;
    }

    void draw_legend(int y) {
        for (std::size_t n = 0; n < legend_.size(); ++n) {
            const auto& [x, row, lines] = legend_[n];
            const int at = y + row * line_;
            fill(image_, {x, at, x + swatch(), at + swatch()}, text_.legend[n].colour);
            frame(image_, {x, at, x + swatch(), at + swatch()}, faint_ink);
            for (std::size_t k = 0; k < lines.size(); ++k)
                write(x + swatch() + gap(), at + static_cast<int>(k) * line_, lines[k], ink);
        }
    }

    [[nodiscard]] std::string world() const {
        const double mpp = extent_.metres_per_pixel;
        const double x0 = extent_.i0 * sector_size_m - left_ * mpp;
        const double y1 = extent_.j1 * sector_size_m + top_ * mpp;
        std::array<char, 160> text{};
        std::snprintf(text.data(),
                      text.size(),
                      "%.17g,%.17g,%.17g,%.17g",
                      x0,
                      y1 - height_ * mpp,
                      x0 + width_ * mpp,
                      y1);
        return text.data();
    }

    const Image& map_;
    const MapExtent& extent_;
    const SheetText& text_;
    const int scale_;
    const int line_;  // pixels from one line of text to the next
    int width_ = 0;   // of the whole
    int height_ = 0;
    int left_ = 0;  // of the map
    int top_ = 0;
    std::vector<std::string> lines_;  // of the title
    std::vector<Placed> legend_;
    int legend_height_ = 0;
    Image image_{0, 0};
};

}  // namespace

MapSheet framed(const Image& map, const MapExtent& extent, const SheetText& text) {
    // Large pictures are looked at from farther away.
    const int usual = static_cast<int>(std::max(map.width, map.height)) / 800;
    for (int scale = std::clamp(usual, min_scale, max_scale);; --scale) {
        Sheet sheet(map, extent, text, scale);
        if (sheet.fits() || scale == min_scale)
            return sheet.draw();
    }
}

}  // namespace drtv::image
