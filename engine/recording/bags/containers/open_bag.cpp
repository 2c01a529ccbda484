// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/stop.h"
#include "engine/files/budget.h"
#include "engine/files/refuse.h"
#include "engine/recording/bags/containers/bag.h"

#include <cerrno>
#include <system_error>
#include <tuple>

#include <fcntl.h>
#include <stdlib.h>  // mkostemp
#include <unistd.h>
#include <zstd.h>

namespace gpo {
namespace {

/// A file in the temporary folder, removed at the end. An open descriptor keeps its content.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path for_file) : for_file_(std::move(for_file)) {
    std::error_code none;
    path_ = (fs::temp_directory_path(none) / "gpo-inspector-XXXXXX").string();
    descriptor_ = mkostemp(path_.data(), O_CLOEXEC);
    if (descriptor_ < 0) fail();
  }
  ~TemporaryFile() {
    close(descriptor_);
    unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }
  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail();
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }

 private:
  [[noreturn]] void fail() const {
    refuse(for_file_,
           "cannot be decompressed to {} ({}); set TMPDIR to a folder with more space",
           path_,
           std::generic_category().message(errno));
  }

  fs::path for_file_;
  std::string path_;
  int descriptor_ = -1;
};

/// Decompresses a file as far as possible. Returns whether it is complete.
bool expand(const FileBytes& file, TemporaryFile& to, const ReadProgress& progress) {
  constexpr std::uint64_t kStep = std::uint64_t{1} << 20;
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  std::string part(kStep, '\0');
  bool ended = false;
  for (std::uint64_t place = 0; place < file.size();) {
    check_stop();
    const std::string stored = file.read(place, kStep);
    if (stored.empty()) return false;
    if (progress) progress(static_cast<double>(place) / static_cast<double>(file.size()));
    ZSTD_inBuffer in{stored.data(), stored.size(), 0};
    bool full = false;  // the stream may hold more output
    while (in.pos < in.size || full) {
      ZSTD_outBuffer out{part.data(), part.size(), 0};
      const std::size_t hint = ZSTD_decompressStream(stream.get(), &out, &in);
      if (ZSTD_isError(hint) != 0) return false;
      spend_expanded(file.path(), file.size(), out.pos);
      to.write({part.data(), out.pos});
      full = out.pos == out.size;
      ended = hint == 0;
    }
    place += stored.size();
  }
  return ended;
}

bool begins_as_bag(std::string_view head) {
  return head.starts_with(kRos1Magic) || head.starts_with(kMcapMagic) ||
         head.starts_with(kSqliteMagic);
}

Bag open_container(const std::shared_ptr<const FileBytes>& bytes,
                   const fs::path& content,
                   const ReadProgress& progress) {
  const fs::path& file = bytes->path();
  const std::string begin = bytes->read(0, 16);
  if (begin.starts_with(kRos1Magic)) return open_ros1_bag(bytes, progress);
  if (begin.starts_with(kMcapMagic)) return open_mcap(bytes, progress);
  if (begin == kSqliteMagic) return open_sqlite_bag(file, content, progress);
  if (begin.starts_with("#ROSRECORD") || begin.starts_with("#ROSLOG"))
    refuse(file, "found an old bag format, expected version 2.0 (rosbag fix converts)");
  refuse(file, "not a bag, expected ROS 1 (version 2.0), MCAP or a SQLite database");
}

Bag open_expanded(const FileBytes& compressed, const ReadProgress& progress) {
  TemporaryFile content(compressed.path());
  const bool whole = expand(compressed, content, progress);
  const auto bytes = std::make_shared<const FileBytes>(compressed.path(), content.path());
  Bag bag = open_container(bytes, content.path(), progress);
  if (!whole) bag.notes.emplace_back("the compressed bag is truncated or broken");
  return bag;
}

/// Returns the first bytes of a message, which may be compressed.
std::string expanded_message(const Bag& stored, const BagMessage& message, std::uint64_t most) {
  constexpr std::uint64_t kFirstBlock = std::uint64_t{256} << 10;
  std::string bytes = stored.read(message, most);
  if (!bytes.starts_with(kZstdMagic)) return bytes;
  const bool all = most == kWholeMessage;
  if (!all) bytes = stored.read(message, std::max(most, kFirstBlock));
  Decompressed made = from_zstd(bytes, std::min(most, kMostMessageBytes));
  if (all && !made.whole) refuse(stored.file, "a message cannot be decompressed (zstd)");
  if (made.bytes.size() > most) made.bytes.resize(most);
  return std::move(made.bytes);
}

}  // namespace

bool is_bag(const FileBytes& file) {
  constexpr std::uint64_t kEnough = std::uint64_t{256} << 10;
  const std::string head = file.read(0, 16);
  return begins_as_bag(head) || (head.starts_with(kZstdMagic) &&
                                 begins_as_bag(from_zstd(file.read(0, kEnough), 16).bytes));
}

Bag open_bag(const fs::path& file, const ReadProgress& progress) {
  const Budget budget(file);
  const auto bytes = std::make_shared<const FileBytes>(file);
  const bool compressed = bytes->read(0, kZstdMagic.size()) == kZstdMagic;
  Bag bag = compressed ? open_expanded(*bytes, progress) : open_container(bytes, file, progress);
  bag.files = {file};
  Bag stored;
  stored.file = file;
  stored.read = std::move(bag.read);
  bag.read = [stored = std::move(stored)](const BagMessage& message, std::uint64_t most_bytes) {
    return expanded_message(stored, message, most_bytes);
  };
  return bag;
}

Bag open_bags(const std::vector<fs::path>& files, const ReadProgress& progress) {
  const Budget budget(fs::path{});
  if (files.size() == 1) return open_bag(files.front(), progress);
  std::vector<Bag> parts;
  using Key = std::tuple<std::string, std::string, MessageEncoding>;
  const auto key_of = [](const BagTopic& topic) {
    return Key(topic.name, topic.type, topic.encoding);
  };
  std::map<Key, BagTopic> topics;
  for (const fs::path& file : files) {
    const auto done = static_cast<double>(parts.size()), all = static_cast<double>(files.size());
    const auto of_part = [&](double share) { progress((done + share) / all); };
    parts.push_back(open_bag(file, progress ? ReadProgress(of_part) : progress));
    for (const BagTopic& topic : parts.back().topics) {
      const auto [known, is_new] = topics.emplace(key_of(topic), topic);
      if (!is_new) known->second.messages += topic.messages;
    }
  }
  Bag bag;
  bag.file = files.front();
  bag.files = files;
  for (const auto& [key, topic] : topics) bag.topics.push_back(topic);
  for (Bag& part : parts) {
    for (BagMessage message : part.messages) {
      const auto topic = topics.find(key_of(part.topics[message.topic]));
      message.topic = static_cast<int>(std::distance(topics.begin(), topic));
      message.part = static_cast<std::uint32_t>(&part - parts.data());
      bag.messages.push_back(message);
    }
    for (const std::string& note : part.notes)
      bag.notes.push_back(part.file.filename().string() + ": " + note);
    part.messages.clear();
  }
  bag.read = [parts = std::make_shared<const std::vector<Bag>>(std::move(parts))](
                 const BagMessage& message, std::uint64_t most_bytes) {
    return (*parts)[message.part].read(message, most_bytes);
  };
  return bag;
}

}  // namespace gpo
