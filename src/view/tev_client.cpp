#include "view/tev_client.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "base/error.h"

namespace troffer {

namespace {

static_assert(std::endian::native == std::endian::little, "packets are little endian");
constexpr uint8_t create_image = 4, update_image = 6;
constexpr const char* image_name = "troffer";
constexpr std::array<const char*, 3> channels{"R", "G", "B"};

// A packet starts with its length in bytes, which includes these four.
class Packet {
 public:
  explicit Packet(uint8_t type) {
    add(uint32_t(0));
    add(type);
    add(uint8_t(0));  // does not bring the image to the front
    add_text(image_name);
  }
  template <class T>
  void add(const T& value) {
    const size_t at = bytes_.size();
    bytes_.resize(at + sizeof(T));
    std::memcpy(bytes_.data() + at, &value, sizeof(T));
  }
  void add_text(const char* text) { bytes_.append(text, std::strlen(text) + 1); }
  void add_channels() {
    add(int32_t(channels.size()));
    for (const char* c : channels) add_text(c);
  }
  void add_pixels(const Image& image) {
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    bytes_.append(reinterpret_cast<const char*>(image.pixels.data()),
                  image.pixels.size() * sizeof(Rgb));
  }
  const std::string& bytes() {
    const auto length = uint32_t(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof(length));
    return bytes_;
  }

 private:
  std::string bytes_;
};

bool send_all(int socket, const std::string& bytes) {
  for (size_t sent = 0; sent < bytes.size();) {
    const ssize_t n = send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) return false;
    sent += size_t(n);
  }
  return true;
}

int connected(const std::string& host, const std::string& port) {
  addrinfo hints = {};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) return -1;
  int s = -1;
  for (const addrinfo* a = found; a != nullptr && s < 0; a = a->ai_next) {
    s = socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
    if (s < 0) continue;
    // A receiver that does not read must not delay the end of the program.
    const timeval limit{5, 0};
    setsockopt(s, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof(limit));
    if (connect(s, a->ai_addr, a->ai_addrlen) == 0) break;
    close(s);
    s = -1;
  }
  freeaddrinfo(found);
  return s;
}

}  // namespace

TevClient::TevClient(const std::string& address) {
  const size_t colon = address.rfind(':');
  const std::string host = address.substr(0, colon);
  const std::string port = colon == address.npos ? "14158" : address.substr(colon + 1);
  if (host.empty() || port.empty() || port.find_first_not_of("0123456789") != port.npos)
    throw UsageError("--tev: '" + address + "' is not HOST:PORT");
  socket_ = connected(host, port);
  if (socket_ < 0) throw EnvironmentError("--tev: no answer from " + address);
  thread_ = std::thread([this] { run(); });
}

TevClient::~TevClient() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  shutdown(socket_, SHUT_RDWR);
  thread_.join();
  close(socket_);
}

void TevClient::show(const Image& picture) {
  const std::lock_guard lock(mutex_);
  next_ = std::make_unique<Image>(picture);
  changed_.notify_all();
}

void TevClient::run() {
  for (;;) {
    std::unique_ptr<Image> picture;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return is_ending_ || next_; });
      if (is_ending_) return;
      picture = std::move(next_);
    }
    if (!send(*picture)) return;
  }
}

bool TevClient::send(const Image& picture) {
  if (picture.width != width_ || picture.height != height_) {
    Packet packet(create_image);
    packet.add(int32_t(picture.width));
    packet.add(int32_t(picture.height));
    packet.add_channels();
    if (!send_all(socket_, packet.bytes())) return false;
    width_ = picture.width;
    height_ = picture.height;
  }
  Packet packet(update_image);
  packet.add_channels();
  for (const int32_t v : {0, 0, picture.width, picture.height}) packet.add(v);
  for (int64_t offset = 0; offset < int64_t(channels.size()); ++offset) packet.add(offset);
  for (size_t i = 0; i < channels.size(); ++i) packet.add(int64_t(channels.size()));
  packet.add_pixels(picture);
  return send_all(socket_, packet.bytes());
}

}  // namespace troffer
