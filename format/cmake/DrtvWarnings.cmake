# The one place for compiler flags: warnings, sanitizers, and the arithmetic that keeps bytes equal.
add_library(drtv_flags INTERFACE)
target_compile_options(drtv_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
  # g++ 12 warns falsely of overlaps in std::string (its bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  # No contraction: a fused multiply-add rounds once where the source rounds twice, so that it would make the
  # result depend on the optimiser.
  -ffp-contract=off)
if(DRTV_WERROR)
  target_compile_options(drtv_flags INTERFACE -Werror)
endif()
if(DRTV_SANITIZE)
  target_compile_options(drtv_flags INTERFACE -fsanitize=${DRTV_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(drtv_flags INTERFACE -fsanitize=${DRTV_SANITIZE})
endif()
