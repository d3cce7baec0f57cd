#include "bakerd/picture/caption.h"
#include "bakerd/picture/compare.h"
#include "bakerd/picture/draw.h"
#include "bakerd/picture/film.h"
#include "bakerd/picture/pick.h"
#include "bakerd/picture/render_request.h"
#include "bakerd/picture/setting.h"
#include "bakerd/picture/view_arguments.h"

#include "format/kit/files.h"
#include "format/kit/progress_bar.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <deque>
#include <memory>
#include <thread>

namespace drtv::picture {
namespace {

constexpr const char* command_name = "render";

// The light of one picture, and what is drawn with it.
struct Hour {
    std::string time;  // empty: light by numbers
    std::unique_ptr<kit::RequestedLight> light = std::make_unique<kit::RequestedLight>();
};

Expected<Hour> read_hour(const kit::LightRequest& request) {
    Hour hour;
    hour.time = request.time.value_or("");
    // What is wrong has been told.
    if (const int code = kit::read_light(request, command_name, *hour.light); code != kit::exit_valid)
        return failed(static_cast<kit::ExitCode>(code), {});
    return hour;
}

Expected<Hour> read_hour(kit::LightRequest request, const std::string& time) {
    request.time = time;
    return read_hour(request);
}

class Rendering {
  public:
    explicit Rendering(const RenderRequest& request) : request_(request) {}

    Expected<void> run() {
        if (auto done = read_light(); !done)
            return done;
        auto setting = Setting::open(request_);
        if (!setting)
            return tl::unexpected(setting.error());
        setting_ = std::move(*setting);
        if (auto done = choose_exposure(); !done)
            return done;
        if (auto done = print_picks(); !done)
            return done;
        if (request_.compare)
            return compare();
        if (request_.out.empty())
            return {};
        return write(sheet());
    }

  private:
    Expected<void> read_light() {
        kit::LightRequest light = request_.light;
        const bool is_dark = !light.time && !light.sun && !light.sky && !light.sky_colours &&
                             light.lights.empty() && light.groups.empty();
        if (is_dark)
            light.time = "12:00";
        std::vector<std::optional<std::string>> times(request_.times.begin(), request_.times.end());
        if (times.empty())
            times.push_back(light.time);
        for (const std::optional<std::string>& time : times) {
            auto hour = time ? read_hour(light, *time) : read_hour(light);
            if (!hour)
                return tl::unexpected(hour.error());
            hours_.push_back(std::move(*hour));
        }
        auto noon = hours_.front().time.empty() ? read_hour(light) : read_hour(light, "12:00");
        if (!noon)
            return tl::unexpected(noon.error());
        noon_ = std::move(*noon);
        return {};
    }

    [[nodiscard]] Moment moment_of(const Hour& hour) const {
        return {setting_->sectors(), *hour.light, setting_->choice(), setting_->window()};
    }

    Expected<void> choose_exposure() {
        const std::string& text = request_.exposure;
        if (text == "noon") {
            ev_ = ev_at_noon();
            return {};
        }
        if (text == "auto")
            return {};
        float ev = 0;
        const auto result = std::from_chars(text.data(), text.data() + text.size(), ev);
        if (result.ec != std::errc() || result.ptr != text.data() + text.size() || !(std::abs(ev) <= 64))
            return failed(
                kit::exit_usage,
                fmt::format("render: --exposure takes noon, auto, or stops from -64 to 64, not \"{}\"",
                            text));
        ev_ = ev;
        return {};
    }

    // Of what is shown; where no light of that is to be seen at noon, at the picture's own hour.
    [[nodiscard]] float ev_at_noon() const {
        const float at_noon = mean_of(noon_);
        const float mean = at_noon > 0 ? at_noon : mean_of(hours_.front());
        return mean > 0 ? ev_for(mean) : 0;
    }
    [[nodiscard]] float ev_of(const Hour& hour) const {
        const float mean = mean_of(hour);
        return mean > 0 ? ev_for(mean) : 0;
    }
    [[nodiscard]] float mean_of(const Hour& hour) const {
        const Show show = setting_->show();
        const Moment moment = moment_of(hour);
        const bool as_all = !is_light(show) || show == Show::probes;
        const Painter painter(setting_->scenery(), moment, setting_->camera(), as_all ? Show::all : show);
        return mean_luminance(painter, setting_->camera(), setting_->scenery().scene());
    }

    Expected<void> print_picks() {
        if (request_.picks.empty())
            return {};
        const Moment moment = moment_of(hours_.front());
        for (const std::string& text : request_.picks) {
            auto line = picked(*setting_, moment, text);
            if (!line)
                return tl::unexpected(line.error());
            std::puts(line->c_str());
        }
        return {};
    }

    [[nodiscard]] kit::Image draw_hour(const Hour& hour, kit::ProgressBar& bar, std::size_t done) const {
        const float ev = ev_ ? *ev_ : ev_of(hour);
        const Moment moment = moment_of(hour);
        Painter painter(setting_->scenery(), moment, setting_->camera(), setting_->show());
        std::optional<TexelAge> age;
        if (setting_->show() == Show::age) {
            const Camera& camera = setting_->camera();
            age.emplace(setting_->sectors(), *hour.light, setting_->choice(), camera.eye(), camera.forward());
            painter.use_age(*age);
        }
        return draw(painter, setting_->camera().size(), exposure_of(ev), [&](std::size_t rows) {
            bar.show(done + rows);
        });
    }

    // Pictures side by side, as near to a square as they go.
    [[nodiscard]] kit::Image sheet() const {
        const Size size = setting_->camera().size();
        const std::size_t steps = draw_steps(size);
        kit::ProgressBar bar("rows", steps * hours_.size());
        if (hours_.size() == 1)
            return draw_hour(hours_.front(), bar, 0);
        const auto columns =
            static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(hours_.size()))));
        const std::size_t rows = (hours_.size() + columns - 1) / columns;
        kit::Image sheet(columns * size.width, rows * size.height);
        for (std::size_t n = 0; n < hours_.size(); ++n) {
            kit::Image picture = draw_hour(hours_[n], bar, n * steps);
            const std::size_t x = n % columns * size.width;
            const std::size_t y = n / columns * size.height;
            for (std::size_t row = 0; row < size.height; ++row)
                std::copy_n(picture.at(0, row), 3 * size.width, sheet.at(x, y + row));
            write_caption(sheet, x + caption_margin, y + caption_margin, hours_[n].time);
        }
        return sheet;
    }

    Expected<void> write(const kit::Image& image) const {
        std::vector<kit::PngText> texts;
        if (request_.top && hours_.size() == 1) {
            const Rectangle& world = setting_->world();
            texts.push_back(
                {kit::world_rectangle_key,
                 fmt::format("{},{},{},{}", world.low.x, world.low.y, world.high.x, world.high.y)});
        }
        const std::string error = kit::write_file(request_.out, kit::encode_png(image, texts));
        if (!error.empty())
            return failed(kit::exit_unreadable, error);
        fmt::print("{}: {} x {} pixels{}\n", request_.out, image.width, image.height, told());
        return {};
    }

    // What was chosen, in the words of the command line.
    [[nodiscard]] std::string told() const {
        std::string text;
        if (setting_->view())
            text += ", --camera " + place_text(setting_->view()->eye) + " --look " +
                    place_text(setting_->view()->look);
        if (is_light(setting_->show()) && ev_)
            text += fmt::format(", --exposure {}", *ev_);
        return text;
    }

    Expected<void> compare() {
        const Hour& hour = hours_.front();
        if (!ev_)
            ev_ = ev_of(hour);
        const Moment moment = moment_of(hour);
        const Comparison comparison =
            compare_with_paths(*setting_, moment, {request_.paths}, exposure_of(*ev_));
        std::fputs(comparison.table.c_str(), stdout);
        return request_.out.empty() ? Expected<void>() : write(comparison.picture);
    }

    static constexpr std::size_t caption_margin = 8;

    const RenderRequest& request_;
    std::deque<Hour> hours_;
    Hour noon_;
    std::unique_ptr<const Setting> setting_;
    std::optional<float> ev_;  // nothing: each picture's own
};

}  // namespace

int run_render(const RenderRequest& request) {
    if (request.out.empty() && request.picks.empty() && !request.compare) {
        kit::complain("render: --out FILE.png says where the picture goes");
        return kit::exit_usage;
    }
    const std::size_t threads = request.threads > 0 ? static_cast<std::size_t>(request.threads)
                                                    : std::max(1u, std::thread::hardware_concurrency());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const auto done = Rendering(request).run();
    if (done)
        return kit::exit_valid;
    if (!done.error().sentence.empty())
        kit::complain(done.error().sentence);
    return done.error().code;
}

}  // namespace drtv::picture
