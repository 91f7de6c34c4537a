// Packets as tev reads them, parsed by a server in its place.
#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <string>

#include "base/error.h"
#include "view/tev_client.h"

using namespace troffer;

namespace {

class Listener {
 public:
  Listener() : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0);
    REQUIRE(listen(socket_, 4) == 0);
    socklen_t size = sizeof(address);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
  }
  ~Listener() { close(socket_); }
  int accepted() const { return accept(socket_, nullptr, nullptr); }

  uint16_t port = 0;

 private:
  int socket_;
};

// A packet after its length.
struct Packet {
  std::string bytes;
  size_t at = 0;
  template <class T>
  T get() {
    T v;
    REQUIRE(at + sizeof(T) <= bytes.size());
    std::memcpy(&v, bytes.data() + at, sizeof(T));
    at += sizeof(T);
    return v;
  }
  std::string text() {
    const std::string t = bytes.c_str() + at;
    at += t.size() + 1;
    return t;
  }
};

Packet packet_from(int socket) {
  uint32_t length = 0;
  REQUIRE(recv(socket, &length, sizeof(length), MSG_WAITALL) == sizeof(length));
  Packet p;
  p.bytes.resize(length - sizeof(length));
  REQUIRE(recv(socket, p.bytes.data(), p.bytes.size(), MSG_WAITALL) == ssize_t(p.bytes.size()));
  return p;
}

void check_head(Packet& p, int type) {
  CHECK(int(p.get<uint8_t>()) == type);
  CHECK(int(p.get<uint8_t>()) == 0);
  CHECK(p.text() == "troffer");
}

void check_channels(Packet& p) {
  REQUIRE(p.get<int32_t>() == 3);
  for (const char* name : {"R", "G", "B"}) CHECK(p.text() == name);
}

void check_update(Packet p, const Image& image) {
  check_head(p, 6);
  check_channels(p);
  for (const int v : {0, 0, image.width, image.height}) CHECK(p.get<int32_t>() == v);
  for (const int64_t v : {0, 1, 2, 3, 3, 3}) CHECK(p.get<int64_t>() == v);
  for (const Rgb& pixel : image.pixels)
    for (size_t c = 0; c < 3; ++c) CHECK(p.get<float>() == pixel[c]);
  CHECK(p.at == p.bytes.size());
}

}  // namespace

TEST_CASE("tev gets an image of the picture's size and then repeated updates") {
  const Listener tev;
  TevClient client("127.0.0.1:" + std::to_string(tev.port));
  const int socket = tev.accepted();
  Image image(3, 2);
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = {float(i), 0.5f, -float(i)};
  client.show(image);
  Packet created = packet_from(socket);
  check_head(created, 4);
  CHECK(created.get<int32_t>() == 3);
  CHECK(created.get<int32_t>() == 2);
  check_channels(created);
  CHECK(created.at == created.bytes.size());
  check_update(packet_from(socket), image);
  image.at(1, 1) = Rgb{7};
  client.show(image);
  check_update(packet_from(socket), image);
  close(socket);
  for (int i = 0; i < 3; ++i) client.show(image);  // nobody reads any more
}

TEST_CASE("addresses that lead nowhere are errors at once") {
  uint16_t closed = 0;
  { closed = Listener().port; }
  CHECK_THROWS_AS(TevClient("127.0.0.1:" + std::to_string(closed)), EnvironmentError);
  for (const char* bad : {"", ":", "127.0.0.1:", "127.0.0.1:x", ":14158"})
    CHECK_THROWS_AS(TevClient{std::string(bad)}, UsageError);
}
