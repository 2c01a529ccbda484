// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/stop.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/bags/containers/bag.h"

#include <algorithm>

#include <sqlite3.h>

namespace gpo {
namespace {

constexpr std::uint64_t kLeastRowBytes = 8;  ///< smallest row in the file
constexpr int kMostTextBytes = 100'000;      ///< names and definitions of tables
constexpr int kMostTopics = 10'000;
constexpr std::size_t kLongestName = 1000;

using Database = std::shared_ptr<sqlite3>;
using Query = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

[[noreturn]] void fail(const fs::path& file, const Database& database) {
  refuse(file, "unreadable database ({}), expected a ROS 2 bag", sqlite3_errmsg(database.get()));
}

/// Returns SQLite's URI of a file, immutable unless there is a write-ahead log beside it.
std::string address_of(const fs::path& file) {
  std::string address = "file:";
  for (const char c : fs::absolute(file).string()) {
    const bool special = c == '?' || c == '#' || c == '%';
    address += special ? fmt::format("%{:02x}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return address + (is_file(file.string() + "-wal") ? "?mode=ro" : "?immutable=1");
}

Database open_database(const fs::path& file, const fs::path& content) {
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(address_of(content).c_str(),
                                   &opened,
                                   SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_FULLMUTEX,
                                   nullptr);
  Database database(opened, sqlite3_close);
  if (code != SQLITE_OK) fail(file, database);
  sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, kMostTextBytes);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  // Lets SQLite read truncated files.
  sqlite3_exec(opened, "PRAGMA writable_schema=ON", nullptr, nullptr, nullptr);
  return database;
}

Query prepare(const fs::path& file, const Database& database, const char* text) {
  sqlite3_stmt* made = nullptr;
  if (sqlite3_prepare_v2(database.get(), text, -1, &made, nullptr) != SQLITE_OK)
    fail(file, database);
  return {made, sqlite3_finalize};
}

std::string text_of(const Query& row, int column) {
  const auto* text = sqlite3_column_text(row.get(), column);
  const int size = sqlite3_column_bytes(row.get(), column);
  return text == nullptr ? "" : std::string(reinterpret_cast<const char*>(text), size);
}

/// Refuses views, which can be endless queries, and virtual tables, which can run code.
void check_is_table(const fs::path& file, const Database& database, const std::string& name) {
  const Query query = prepare(
      file, database, "SELECT sql FROM sqlite_master WHERE type = 'table' AND name = ?1 LIMIT 1");
  sqlite3_bind_text(query.get(), 1, name.c_str(), -1, SQLITE_TRANSIENT);
  const int code = sqlite3_step(query.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) fail(file, database);
  if (code == SQLITE_ROW && text_of(query, 0).starts_with("CREATE TABLE")) return;
  refuse(file, "the database has no table `{}`, expected a ROS 2 bag", name);
}

void add_topics(const fs::path& file, const Database& database, TopicList& topics) {
  const Query query =
      prepare(file, database, "SELECT id, name, type, serialization_format FROM topics");
  int code = SQLITE_ROW;
  for (int i = 0; i < kMostTopics && (code = sqlite3_step(query.get())) == SQLITE_ROW; ++i) {
    const auto encoding =
        text_of(query, 3) == "cdr" ? MessageEncoding::cdr : MessageEncoding::unknown;
    const std::string name = text_of(query, 1);
    const std::string type = text_of(query, 2);
    if (std::max(name.size(), type.size()) > kLongestName) continue;
    topics.add(sqlite3_column_int64(query.get(), 0), name, type, encoding);
  }
  if (code != SQLITE_DONE) fail(file, database);
}

/// Adds the messages in the order of rows without reading their data. Returns whether all rows were
/// readable.
bool add_messages(const fs::path& file,
                  const fs::path& content,
                  const Database& database,
                  TopicList& topics,
                  const ReadProgress& progress) {
  const Query query = prepare(
      file, database, "SELECT rowid, topic_id, timestamp FROM messages NOT INDEXED ORDER BY rowid");
  const std::uint64_t most = FileBytes(content).size() / kLeastRowBytes;
  std::optional<std::int64_t> last;
  int code = SQLITE_ROW;
  for (std::uint64_t i = 0; i <= most; ++i) {
    check_stop();
    if (progress) progress(0);
    code = sqlite3_step(query.get());
    if (code != SQLITE_ROW) break;
    const std::int64_t id = sqlite3_column_int64(query.get(), 0);
    if (last && id <= *last) return false;  // cyclic pages
    last = id;
    topics.add_message(sqlite3_column_int64(query.get(), 1),
                       sqlite3_column_int64(query.get(), 2),
                       0,
                       static_cast<std::uint64_t>(id));
  }
  return code == SQLITE_DONE;
}

/// Reads messages by rows; reopening a handle is faster than opening a new one.
class RowReader {
 public:
  RowReader(fs::path file, Database database)
      : file_(std::move(file)), database_(std::move(database)) {}

  std::string read(const BagMessage& message, std::uint64_t most_bytes) {
    check_stop();
    const std::scoped_lock lock(mutex_);
    const auto row = static_cast<sqlite3_int64>(message.place);
    if (!go_to(row)) broken(row);
    const auto size = static_cast<std::uint64_t>(sqlite3_blob_bytes(blob_.get()));
    std::string bytes(std::min({size, most_bytes, kMostMessageBytes}), '\0');
    const int code =
        sqlite3_blob_read(blob_.get(), bytes.data(), static_cast<int>(bytes.size()), 0);
    if (code != SQLITE_OK) broken(row);
    return bytes;
  }

 private:
  using Blob = std::unique_ptr<sqlite3_blob, int (*)(sqlite3_blob*)>;

  bool go_to(sqlite3_int64 row) {
    if (blob_ && sqlite3_blob_reopen(blob_.get(), row) == SQLITE_OK) return true;
    blob_.reset();
    sqlite3_blob* opened = nullptr;
    const int code =
        sqlite3_blob_open(database_.get(), "main", "messages", "data", row, 0, &opened);
    blob_.reset(opened);
    return code == SQLITE_OK;
  }
  [[noreturn]] void broken(sqlite3_int64 row) {
    blob_.reset();
    refuse(file_, "message {} cannot be read ({})", row, sqlite3_errmsg(database_.get()));
  }

  fs::path file_;
  Database database_;
  std::mutex mutex_;
  Blob blob_{nullptr, sqlite3_blob_close};
};

bool can_be_read(RowReader& rows, const BagMessage& message) {
  try {
    rows.read(message, kWholeMessage);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

Bag open_sqlite_bag(const fs::path& file, const fs::path& content, const ReadProgress& progress) {
  const Database database = open_database(file, content);
  for (const char* table : {"topics", "messages"}) check_is_table(file, database, table);
  Bag bag;
  bag.file = file;
  TopicList topics(bag, FileBytes(content).size());
  add_topics(file, database, topics);
  const auto rows = std::make_shared<RowReader>(file, database);
  if (!add_messages(file, content, database, topics, progress)) {
    // The last row may be partly missing.
    while (!bag.messages.empty() && !can_be_read(*rows, bag.messages.back()))
      bag.messages.pop_back();
    bag.notes.push_back("the bag is truncated or broken: could read only " +
                        counted(bag.messages.size(), "message"));
  }
  topics.finish();
  bag.read = [rows](const BagMessage& message, std::uint64_t most_bytes) {
    return rows->read(message, most_bytes);
  };
  return bag;
}

}  // namespace gpo
