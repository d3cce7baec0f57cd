// What `--version` says.
#pragma once

#include <string>
#include <string_view>

namespace drtv::cli {

// The instruction set class that this part is built for: "x86-64", "x86-64-avx2", "aarch64".
[[nodiscard]] std::string_view built_isa_class();

// "drtv 0.1.0 (commit 929deb9, x86-64)", and `more` in the brackets.
[[nodiscard]] std::string version_text(std::string_view program,
                                       std::string_view isa_class = built_isa_class(),
                                       std::string_view more = "");

}  // namespace drtv::cli
