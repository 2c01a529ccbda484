// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/live/sender.h"

#include "engine/files/text_file.h"
#include "tests/engine/recording/images/made_video.h"

#include <chrono>
#include <filesystem>

#include <arpa/inet.h>
#include <opencv2/imgproc.hpp>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace gpo::test {
namespace {

constexpr std::chrono::milliseconds kPause{1};
constexpr int kPoll_ms = 20;

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int bind_any(int socket) {
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  if (::bind(socket, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("no free port at the loopback address");
  return ntohs(address.sin_port);
}

}  // namespace

bool Client::send(const std::string& bytes) const {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t sent =
        ::send(socket_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      done += static_cast<std::size_t>(sent);
      continue;
    }
    if (errno != EAGAIN && errno != EINTR) return false;
    if (stop_.stop_requested()) return false;
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

bool Client::wait(const std::function<bool()>& condition) const {
  while (!condition()) {
    if (stop_.stop_requested()) return false;
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

HttpSender::HttpSender(Serve serve) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  port_ = bind_any(socket_);
  ::listen(socket_, 4);
  thread_ = std::jthread([this, serve = std::move(serve)](const std::stop_token& stop) {
    for (int number = 0; !stop.stop_requested();) {
      pollfd waiting{socket_, POLLIN, 0};
      if (::poll(&waiting, 1, kPoll_ms) <= 0) continue;
      const int client = ::accept(socket_, nullptr, nullptr);
      if (client < 0) continue;
      std::string request;
      while (request.find("\r\n\r\n") == std::string::npos) {
        std::array<char, 1024> bytes{};
        const ssize_t got = ::recv(client, bytes.data(), bytes.size(), 0);
        if (got <= 0) break;
        request.append(bytes.data(), static_cast<std::size_t>(got));
      }
      serve(Client(client, stop), number++);
      ::shutdown(client, SHUT_RDWR);
      ::close(client);
    }
  });
}

HttpSender::~HttpSender() {
  thread_.request_stop();
  thread_.join();
  ::close(socket_);
}

std::string HttpSender::address() const {
  return "http://127.0.0.1:" + std::to_string(port_) + "/video";
}

int free_port() {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  const int port = bind_any(socket);
  ::close(socket);
  return port;
}

void send_datagrams(int port, const std::string& bytes, const std::stop_token& stop) {
  constexpr std::size_t kDatagram = 7 * std::size_t{188};
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in address = loopback(port);
  ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  // A refused datagram makes the next one fail.
  const std::string nothing(188, '\xFF');
  const auto is_refused = [&] {
    ::send(socket, nothing.data(), nothing.size(), 0);
    std::this_thread::sleep_for(kPause);
    return ::send(socket, nothing.data(), nothing.size(), 0) < 0;
  };
  while (is_refused() && !stop.stop_requested()) {
  }
  for (std::size_t begin = 0; begin < bytes.size() && !stop.stop_requested(); begin += kDatagram) {
    ::send(socket, bytes.data() + begin, std::min(kDatagram, bytes.size() - begin), 0);
    std::this_thread::sleep_for(kPause);
  }
  ::close(socket);
}

std::string http_head(const std::string& type) {
  return "HTTP/1.0 200 OK\r\nContent-Type: " + type + "\r\n\r\n";
}

std::string jpeg_part(const std::string& jpeg) {
  return "--frame\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg.size()) +
         "\r\n\r\n" + jpeg + "\r\n";
}

std::vector<std::string> jpegs_of(const std::vector<cv::Mat>& images) {
  const std::filesystem::path file = std::filesystem::path(GPO_TEST_OUTPUT_DIR) /
                                     ("jpegs-" + std::to_string(::getpid()) + ".mjpeg");
  std::filesystem::create_directories(file.parent_path());
  make_video(file, images);
  const std::string bytes = read_file(file);
  std::filesystem::remove(file);
  std::vector<std::string> jpegs;
  const std::string start = "\xFF\xD8\xFF";
  for (std::size_t at = bytes.find(start); at != std::string::npos;) {
    const std::size_t next = bytes.find(start, at + 1);
    jpegs.push_back(bytes.substr(at, next == std::string::npos ? next : next - at));
    at = next;
  }
  return jpegs;
}

std::vector<cv::Mat> moving_images(int count, cv::Size size) {
  cv::Mat texture(size.height, size.width + 2 * count, CV_8UC3);
  cv::RNG random(7);
  random.fill(texture, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(texture, texture, {}, 4);
  cv::normalize(texture, texture, 20, 230, cv::NORM_MINMAX);
  std::vector<cv::Mat> images;
  for (int i = 0; i < count; ++i) images.push_back(texture(cv::Rect({2 * i, 0}, size)).clone());
  return images;
}

LiveClock HandClock::clock() {
  return {[this] { return now_ns.load(); },
          [this](std::int64_t time_ns, const std::stop_token& stop) {
            if (!stop.stop_requested() && time_ns > now_ns) now_ns = time_ns;
            std::this_thread::sleep_for(kPause);
          }};
}

std::vector<LiveImage> take_all(Capture& capture) {
  std::vector<LiveImage> images;
  while (auto image = capture.take({})) images.push_back(std::move(*image));
  return images;
}

void wait_for(const Capture& capture, const std::function<bool(const CaptureStatus&)>& condition) {
  while (!condition(capture.status())) std::this_thread::sleep_for(kPause);
}

}  // namespace gpo::test
