#include "bakerd/picture/compare.h"
#include "bakerd/picture/draw.h"
#include "bakerd/picture/film.h"
#include "bakerd/picture/hours.h"
#include "bakerd/picture/pick.h"
#include "bakerd/picture/render_request.h"
#include "bakerd/picture/shot.h"
#include "bakerd/picture/view_arguments.h"

#include "format/cli/number_list.h"
#include "format/cli/report.h"
#include "format/image/canvas.h"
#include "format/image/png_file.h"
#include "format/kit/progress_bar.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

namespace drtv::picture {
namespace {

class Rendering {
  public:
    explicit Rendering(const RenderRequest& request) : request_(request) {}

    cli::Result<void> run() {
        auto hours = read_hours(request_);
        if (!hours)
            return tl::unexpected(hours.error());
        hours_ = std::move(hours->shown);
        noon_ = std::move(hours->noon);
        if (auto done = read_exposure(); !done)
            return done;
        if (!request_.out.empty()) {
            if (auto target = image::check_png_target(request_.out); !target)
                return target;
        }
        auto shot = Shot::open(request_);
        if (!shot)
            return tl::unexpected(shot.error());
        shot_ = std::move(*shot);
        // Groups and lamps are the same at all hours.
        kit::warn_of_lost_light(shot_->sectors(), *hours_.front().light, "in sight");
        if (auto done = check_size(); !done)
            return done;
        if (auto done = print_picks(); !done)
            return done;
        if (request_.out.empty() && !request_.compare)
            return {};
        if (!sees_anything(shot_->camera(), shot_->scenery().scene()))
            cli::warn("nothing of the map is in sight");
        if (request_.exposure == "noon")
            ev_ = ev_at_noon();
        return request_.compare ? compare() : write(sheet());
    }

  private:
    [[nodiscard]] Moment moment_of(const Hour& hour) const {
        return {shot_->sectors(), *hour.light, shot_->choice(), shot_->window()};
    }

    // Where it is a number.
    cli::Result<void> read_exposure() {
        const std::string& text = request_.exposure;
        if (text == "noon" || text == "auto")
            return {};
        constexpr double most = 128;
        const auto stops = cli::number_list(text, 1);
        if (!stops || std::abs(stops->front()) > most)
            return cli::fail(
                cli::exit_usage,
                fmt::format("render: --exposure takes noon, auto, or stops from -{} to {}, not \"{}\"",
                            most,
                            most,
                            text));
        ev_ = static_cast<float>(stops->front());
        return {};
    }

    // Of what is shown; where no light of that is to be seen at noon, at the picture's own hour.
    [[nodiscard]] float ev_at_noon() const {
        const std::optional<double> at_noon = brightness_of(noon_);
        return at_noon ? ev_for(*at_noon) : ev_of(hours_.front());
    }
    [[nodiscard]] float ev_of(const Hour& hour) const {
        const std::optional<double> brightness = brightness_of(hour);
        return brightness ? ev_for(*brightness) : 0;
    }
    [[nodiscard]] std::optional<double> brightness_of(const Hour& hour) const {
        const Show show = shot_->show();
        const Moment moment = moment_of(hour);
        const Show exposed = is_surface_light(show) ? show : Show::all;
        const Painter painter(shot_->scenery(), moment, shot_->camera(), exposed);
        return brightness_log2(painter, shot_->camera(), shot_->scenery().scene());
    }

    cli::Result<void> print_picks() {
        if (request_.picks.empty())
            return {};
        for (const Hour& hour : hours_) {
            const Moment moment = moment_of(hour);
            for (const std::string& text : request_.picks) {
                auto line = picked(*shot_, moment, hour.time, text);
                if (!line)
                    return tl::unexpected(line.error());
                std::puts(line->c_str());
            }
        }
        return {};
    }

    [[nodiscard]] image::Image draw_hour(const Hour& hour, kit::ProgressBar& bar, std::size_t done) {
        const float ev = ev_ ? *ev_ : ev_of(hour);
        if (!ev_ || shown_evs_.empty())
            shown_evs_.push_back(ev);
        const Moment moment = moment_of(hour);
        Painter painter(shot_->scenery(), moment, shot_->camera(), shot_->show());
        std::optional<TexelAge> age;
        if (shot_->show() == Show::age) {
            const Camera& camera = shot_->camera();
            age.emplace(shot_->sectors(), *hour.light, shot_->choice(), camera.eye(), camera.forward());
            painter.use_age(*age);
        }
        return draw(painter, shot_->camera().size(), exposure_of(ev), [&](std::size_t rows) {
            bar.show(done + rows);
        });
    }

    [[nodiscard]] std::size_t sheet_columns() const {
        return static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(hours_.size()))));
    }

    // Of all pictures side by side.
    cli::Result<void> check_size() const {
        const Size size = shot_->camera().size();
        const std::size_t columns = request_.compare ? 3 : sheet_columns();
        const std::size_t rows = (hours_.size() + columns - 1) / columns;
        const std::size_t pixels = columns * rows * size.width * size.height;
        if (pixels <= max_pixels)
            return {};
        return cli::fail(
            cli::exit_usage,
            fmt::format("render: {} x {} pictures of {} would have {} million pixels, over 64 million",
                        columns,
                        rows,
                        request_.size,
                        pixels / 1'000'000));
    }

    // Pictures side by side, as near to a square as they go.
    [[nodiscard]] image::Image sheet() {
        const Size size = shot_->camera().size();
        const std::size_t steps = draw_steps(shot_->show(), size);
        kit::ProgressBar bar("rows", steps * hours_.size());
        if (request_.times.empty())
            return draw_hour(hours_.front(), bar, 0);
        const std::size_t columns = sheet_columns();
        const std::size_t rows = (hours_.size() + columns - 1) / columns;
        image::Image sheet(columns * size.width, rows * size.height);
        for (std::size_t n = 0; n < hours_.size(); ++n) {
            image::Image picture = draw_hour(hours_[n], bar, n * steps);
            const std::size_t x = n % columns * size.width;
            const std::size_t y = n / columns * size.height;
            for (std::size_t row = 0; row < size.height; ++row)
                std::copy_n(picture.at(0, row), 3 * size.width, sheet.at(x, y + row));
            image::write_caption(sheet,
                                 static_cast<int>(x + caption_margin),
                                 static_cast<int>(y + caption_margin),
                                 hours_[n].time);
        }
        return sheet;
    }

    cli::Result<void> write(const image::Image& image) const {
        std::vector<image::PngText> texts;
        if (request_.top && hours_.size() == 1 && !request_.compare) {
            const trace::WorldRectangle& world = shot_->world();
            texts.push_back(
                {image::world_rectangle_key,
                 fmt::format("{},{},{},{}", world.low.x, world.low.y, world.high.x, world.high.y)});
        }
        if (auto written = image::write_png_file(request_.out, image, texts); !written)
            return written;
        fmt::print("{}: {} x {} pixels{}\n", request_.out, image.width, image.height, told());
        return {};
    }

    // What was chosen, in the words of the command line.
    [[nodiscard]] std::string told() const {
        std::string text;
        if (shot_->view())
            text +=
                ", --camera " + place_text(shot_->view()->eye) + " --look " + place_text(shot_->view()->look);
        if (is_light(shot_->show()))
            text += fmt::format(", --exposure {}", fmt::join(shown_evs_, ", "));
        return text;
    }

    cli::Result<void> compare() {
        const Hour& hour = hours_.front();
        if (!ev_)
            ev_ = ev_of(hour);
        shown_evs_ = {*ev_};
        const Moment moment = moment_of(hour);
        const Comparison comparison = compare_with_paths(*shot_, moment, {request_.paths}, exposure_of(*ev_));
        std::fputs(comparison.table.c_str(), stdout);
        return request_.out.empty() ? cli::Result<void>() : write(comparison.picture);
    }

    static constexpr std::size_t caption_margin = 8;

    const RenderRequest& request_;
    std::vector<Hour> hours_;
    Hour noon_;
    std::unique_ptr<const Shot> shot_;
    std::optional<float> ev_;       // nothing: each picture's own
    std::vector<float> shown_evs_;  // of all pictures, or of each
};

}  // namespace

cli::Result<cli::ExitCode> run_render(const RenderRequest& request) {
    if (request.out.empty() && request.picks.empty() && !request.compare)
        return cli::fail(cli::exit_usage, "render: --out FILE.png says where the picture goes");
    const std::size_t threads = request.threads > 0 ? static_cast<std::size_t>(request.threads)
                                                    : std::max(1u, std::thread::hardware_concurrency());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return Rendering(request).run().map([] { return cli::exit_done; });
}

}  // namespace drtv::picture
