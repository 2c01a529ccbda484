// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/live/capture.h"

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace gpo::test {

/// One client of an `HttpSender`.
class Client {
 public:
  Client(int socket, const std::stop_token& stop) : socket_(socket), stop_(stop) {}

  /// Sends bytes; returns false if the client is gone.
  bool send(const std::string& bytes) const;
  /// Waits until the condition holds; returns false if the sender ends before.
  bool wait(const std::function<bool()>& condition) const;

 private:
  int socket_;
  std::stop_token stop_;
};

/// Serves clients at the loopback address one after the other, each by `serve`.
class HttpSender {
 public:
  /// `number` counts the clients from 0.
  using Serve = std::function<void(const Client& client, int number)>;
  explicit HttpSender(Serve serve);
  ~HttpSender();
  HttpSender(const HttpSender&) = delete;
  HttpSender& operator=(const HttpSender&) = delete;

  std::string address() const;

 private:
  int socket_;
  int port_ = 0;
  std::jthread thread_;
};

/// Returns a port without a listener.
int free_port();
/// Sends a file in datagrams to a port at the loopback address, once there is a listener.
void send_datagrams(int port, const std::string& bytes, const std::stop_token& stop);

/// The head of an answer, and of one JPEG in a stream of them.
std::string http_head(const std::string& type);
std::string jpeg_part(const std::string& jpeg);
/// Returns the files of JPEG images.
std::vector<std::string> jpegs_of(const std::vector<cv::Mat>& images);

/// Textured images that move by two pixels from one to the next.
std::vector<cv::Mat> moving_images(int count, cv::Size size);

/// A clock that only moves by `wait_until` and `advance`.
struct HandClock {
  std::atomic<std::int64_t> now_ns = 1'700'000'000'000'000'000;

  LiveClock clock();
  void advance(double seconds) { now_ns += static_cast<std::int64_t>(seconds * 1e9); }
};

/// Takes all images until the capture is over.
std::vector<LiveImage> take_all(Capture& capture);
/// Waits until the state satisfies the condition.
void wait_for(const Capture& capture, const std::function<bool(const CaptureStatus&)>& condition);

}  // namespace gpo::test
