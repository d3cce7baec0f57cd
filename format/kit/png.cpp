#include "png.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace drtv::kit {
namespace {

void append(void* png, void* data, int size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    auto& out = *static_cast<std::vector<std::uint8_t>*>(png);
    out.insert(out.end(), bytes, bytes + size);
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image) {
    constexpr int channels = 3;
    const int width = static_cast<int>(image.width);
    const int height = static_cast<int>(image.height);
    std::vector<std::uint8_t> png;
    if (stbi_write_png_to_func(append, &png, width, height, channels, image.rgb.data(), width * channels) ==
        0)
        png.clear();
    return png;
}

}  // namespace drtv::kit
