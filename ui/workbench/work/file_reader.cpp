// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/experiment/row.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench/work/worker.h"

namespace gpo {

FileReader::Task reading_of(const fs::path& file,
                            const MethodTable& methods,
                            const ReadMethods& read_methods) {
  return [file, known = SessionMethods{methods}, read_methods](const Progress& progress) {
    progress("reading " + file.filename().string(), 0, 0);
    ReadFile read{file};
    try {
      // By its name, too: then the error names the missing column, not a video.
      if (file.filename() == "results.csv" || is_results(file)) {
        read.rows = std::make_shared<const std::vector<Row>>(read_results(file, known.table));
      } else if (is_session(file)) {
        const SessionMethods of_session = read_methods ? read_methods(file) : known;
        read.session = read_session(file, of_session.table);
        read.add_methods = of_session.add;
      }
    } catch (const std::exception& error) {
      read.error = message_of(error);
    }
    return read;
  };
}

}  // namespace gpo
