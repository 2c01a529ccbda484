// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

namespace gpo {

/// A file descriptor that is closed at the end.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  int number() const { return number_; }  ///< -1: closed
  bool is_open() const { return number_ >= 0; }
  void close();

 private:
  int number_ = -1;
};

/// What is written into one end comes out of the other; no child inherits either.
struct Pipe {
  Descriptor reads, writes;
};
/// Throws std::system_error.
Pipe make_pipe();

/// Reads and writes of it return at once.
void make_nonblocking(const Descriptor& descriptor);

}  // namespace gpo
