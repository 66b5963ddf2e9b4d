// SPDX-License-Identifier: MIT
/// The files of the page. They are part of the program, so there is no folder to find, and nobody can change them.
#include "server.hpp"

// The assembler copies the bytes of a file into the program. HAPTICD_VIEW_BUNDLE is the folder of the files.
#define HAPTICD_VIEW_FILE(symbol, file)                                                                                \
  __asm__(".section .rodata\n.global hapticd_view_" symbol "\n.balign 16\nhapticd_view_" symbol                        \
          ":\n.incbin \"" HAPTICD_VIEW_BUNDLE "/" file "\"\n.global hapticd_view_" symbol "_end\nhapticd_view_" symbol \
          "_end:\n.byte 0\n.previous\n")

HAPTICD_VIEW_FILE("index", "index.html");
HAPTICD_VIEW_FILE("script", "app.js");
HAPTICD_VIEW_FILE("style", "app.css");
HAPTICD_VIEW_FILE("icon", "icon.svg");

extern "C" {
extern const char hapticd_view_index[], hapticd_view_index_end[];
extern const char hapticd_view_script[], hapticd_view_script_end[];
extern const char hapticd_view_style[], hapticd_view_style_end[];
extern const char hapticd_view_icon[], hapticd_view_icon_end[];
}

namespace hapticd::view {

Asset assetOf(const std::string& path) {
  const auto between = [](const char* begin, const char* end) {
    return std::string_view(begin, static_cast<size_t>(end - begin));
  };
  if (path == "/") return {"text/html; charset=utf-8", between(hapticd_view_index, hapticd_view_index_end)};
  if (path == "/app.js")
    return {"text/javascript; charset=utf-8", between(hapticd_view_script, hapticd_view_script_end)};
  if (path == "/app.css") return {"text/css; charset=utf-8", between(hapticd_view_style, hapticd_view_style_end)};
  if (path == "/icon.svg") return {"image/svg+xml", between(hapticd_view_icon, hapticd_view_icon_end)};
  return {};
}

}  // namespace hapticd::view
