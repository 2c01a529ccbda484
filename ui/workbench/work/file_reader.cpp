// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/experiment/row.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench/work/worker.h"

#include <utility>

namespace gpo {

FileReader::FileReader(std::function<void()> changed)
    : job_([this] { return next(); }, std::move(changed)) {}

void FileReader::read(const fs::path& file,
                      const MethodTable& methods,
                      const ReadMethods& read_methods) {
  const auto lock = job_.lock();
  job_.cancel();
  wanted_ = file;
  methods_ = methods;
  read_methods_ = read_methods;
  read_.reset();
  job_.wake();
}

void FileReader::cancel() {
  const auto lock = job_.lock();
  job_.cancel();
  wanted_.clear();
  read_.reset();
}

JobStatus FileReader::status() const {
  const auto lock = job_.lock();
  return job_.status();
}

std::optional<ReadFile> FileReader::take() {
  const auto lock = job_.lock();
  return std::exchange(read_, {});
}

BackgroundJob::Job FileReader::next() {
  if (wanted_.empty()) return nullptr;
  return [this,
          file = std::exchange(wanted_, {}),
          known = SessionMethods{methods_},
          read_methods = read_methods_](const std::stop_token& stop) {
    job_.report(stop, "reading " + file.filename().string(), 0, 0);
    ReadFile read{file};
    try {
      // By its name, too: then the error names the missing column, not a video.
      if (file.filename() == "results.csv" || is_results(file)) {
        read.rows = std::make_shared<const std::vector<Row>>(read_results(file, known.table));
      } else if (is_session(file)) {
        const SessionMethods methods = read_methods ? read_methods(file) : known;
        read.session = read_session(file, methods.table);
        read.add_methods = methods.add;
      }
    } catch (const std::exception& error) {
      read.error = message_of(error);
    }
    job_.publish(stop, [&] { read_ = std::move(read); });
  };
}

}  // namespace gpo
