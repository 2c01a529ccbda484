// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/libav_functions.h"

#include <atomic>
#include <string>

#include <fmt/format.h>

namespace gpo::libav {
namespace {

struct Library {
  std::string file;
  void* handle;
  Library(const char* name, int version)
      : file(fmt::format("{}.so.{}", name, version)), handle(load_library(file.c_str())) {}
};

std::atomic<void (*)()> first_call = nullptr;

}  // namespace

void* find(const char* name) {
  // The second and third are loaded only if the ones before lack the function.
  static const Library util("libavutil", LIBAVUTIL_VERSION_MAJOR);
  if (void* const address = find_symbol(util.handle, name)) return address;
  static const Library format = [] {
    if (void (*const call)() = first_call) call();
    return Library("libavformat", LIBAVFORMAT_VERSION_MAJOR);  // also has those of libavcodec
  }();
  if (void* const address = find_symbol(format.handle, name)) return address;
  static const Library scale("libswscale", LIBSWSCALE_VERSION_MAJOR);
  if (void* const address = find_symbol(scale.handle, name)) return address;
  refuse_symbol(format.file.c_str(), name);
}

void* find_in_devices(const char* name) {
  find("avformat_open_input");  // loads the libraries that it needs
  static const Library devices("libavdevice", LIBAVDEVICE_VERSION_MAJOR);
  if (void* const address = find_symbol(devices.handle, name)) return address;
  refuse_symbol(devices.file.c_str(), name);
}

void before_loading(void (*call)()) { first_call = call; }

}  // namespace gpo::libav
