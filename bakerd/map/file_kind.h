// What a file is that is no glTF.
#pragma once

#include <string_view>

namespace drtv::map {

// The end of a sentence that begins with "it is", and what to do: "a Blender file: export it as glTF 2.0".
// Empty where the bytes begin like no kind of file that people hand in by mistake.
[[nodiscard]] std::string_view foreign_kind(std::string_view bytes);

}  // namespace drtv::map
