// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gpo {

/// A value in GPMF with its key; all numbers are big endian.
struct GpmfItem {
  std::string_view key;  ///< four letters
  char type = 0;         ///< a letter; 0: items inside
  int size = 0;          ///< of a sample [bytes]
  int count = 0;         ///< of samples
  std::string_view data;
};

/// Takes items off the front of what holds them.
class GpmfItems {
 public:
  GpmfItems(std::string_view bytes, const std::string& source) : rest_(bytes), source_(source) {}

  /// Nothing at the end, which may be padded by zeros. Throws InputError, which names `source`.
  std::optional<GpmfItem> next();

 private:
  std::string_view rest_;
  const std::string& source_;
};

/// Of a number [bytes]; 0: it is none.
int gpmf_size(char type);

/// All of its numbers, finite. Throws InputError.
std::vector<double> gpmf_numbers(const GpmfItem& item, const std::string& source);

/// Without the zeros at its end.
std::string gpmf_text(const GpmfItem& item);

/// "SOURCE: KEY: found FOUND, expected EXPECTED".
[[noreturn]] void gpmf_fail(const std::string& source,
                            const GpmfItem& item,
                            const std::string& found,
                            const std::string& expected);

}  // namespace gpo
