// Requests that no honest browser sends are refused, and cost nothing.
#include <doctest/doctest.h>

#include <memory>
#include <thread>
#include <vector>

#include "base/error.h"
#include "client.h"
#include "view/http_server.h"
#include "view/token.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const std::string token = "0123456789abcdef0123456789abcdef";

struct Server {
  explicit Server(const HttpLimits& limits = {})
      : server(
            0, token,
            [this](const HttpRequest& r) {
              ++calls;
              last = r;
              if (r.path == "fails") throw UsageError("no");
              if (r.path == "breaks") throw std::runtime_error("broken");
              return HttpResponse{200, "text/plain", "hello " + r.path, ""};
            },
            limits) {}

  std::string host() const { return "127.0.0.1:" + std::to_string(server.port()); }
  // Returns the answer to a whole request, after which the connection should end.
  std::string ask(const std::string& line, const std::string& more = {},
                  const std::string& body = {}) const {
    const Client client(server.port());
    REQUIRE(client.is_connected());
    client.send(line + " HTTP/1.1\r\nHost: " + host() + "\r\nConnection: close\r\n" + more +
                "\r\n" + body);
    return client.rest();
  }

  int calls = 0;
  HttpRequest last;
  HttpServer server;
};

}  // namespace

TEST_CASE("requests with the token are answered, with the page's security headers") {
  Server s;
  const std::string answer = s.ask("GET /" + token + "/state?a=1&b=x%20y");
  CHECK(status_of(answer) == 200);
  CHECK(body_of(answer) == "hello state");
  CHECK(s.last.query["a"] == "1");
  CHECK(s.last.query["b"] == "x y");
  CHECK(answer.find("Content-Security-Policy: default-src 'none'") != answer.npos);
  CHECK(answer.find("X-Content-Type-Options: nosniff") != answer.npos);
  CHECK(answer.find("Referrer-Policy: no-referrer") != answer.npos);
  CHECK(answer.find("Cache-Control: no-store") != answer.npos);
  CHECK(status_of(s.ask("POST /" + token + "/camera", "Content-Length: 4\r\n", "{\"\"}")) == 200);
  CHECK(s.last.is_post);
  CHECK(s.last.body == "{\"\"}");
  CHECK(s.server.address() == "http://" + s.host() + "/" + token + "/");
}

TEST_CASE("requests without the token get nothing") {
  Server s;
  std::string wrong = token;
  wrong[5] = 'x';
  for (const std::string& path :
       {std::string("/"), std::string("/state"), "/" + wrong + "/state", "/" + token,
        "/" + token.substr(1) + "/state", "/" + token + token + "/state", "//" + token + "/state",
        "/" + wrong + "/../" + token + "/state", std::string("/favicon.ico")})
    CHECK(status_of(s.ask("GET " + path)) == 404);
  CHECK(s.calls == 0);
}

TEST_CASE("other hosts and origins are refused (DNS rebinding)") {
  Server s;
  const auto with_host = [&](const std::string& host) {
    const Client client(s.server.port());
    client.send("GET /" + token + "/state HTTP/1.1\r\nHost: " + host +
                "\r\nConnection: close\r\n\r\n");
    return status_of(client.rest());
  };
  CHECK(with_host(s.host()) == 200);
  CHECK(with_host("localhost:" + std::to_string(s.server.port())) == 200);
  CHECK(with_host("evil.example:" + std::to_string(s.server.port())) == 403);
  CHECK(with_host("127.0.0.1") == 403);
  CHECK(with_host("127.0.0.1.evil.example:" + std::to_string(s.server.port())) == 403);
  CHECK(with_host("") == 403);
  CHECK(status_of(s.ask("POST /" + token + "/camera", "Origin: http://evil.example\r\n")) == 403);
  CHECK(status_of(s.ask("POST /" + token + "/camera", "Origin: null\r\n")) == 403);
  CHECK(status_of(s.ask("POST /" + token + "/camera",
                        "Origin: http://" + s.host() + "\r\nContent-Length: 0\r\n")) == 200);
  CHECK(s.calls == 3);
}

TEST_CASE("bodies and headers have size limits, and only allowed methods are accepted") {
  HttpLimits limits;
  limits.body_bytes = 1000;
  Server s(limits);
  const std::string post = "POST /" + token + "/camera";
  CHECK(status_of(s.ask(post, "Content-Length: 1000\r\n", std::string(1000, 'x'))) == 200);
  CHECK(status_of(s.ask(post, "Content-Length: 1001\r\n")) == 413);
  CHECK(status_of(s.ask(post, "Content-Length: 99999999999999\r\n")) != 200);
  CHECK(status_of(s.ask(post, "Content-Length: -1\r\n")) != 200);
  CHECK(s.calls == 1);
  // A body without a stated length, piece by piece.
  std::string pieces;
  for (int i = 0; i < 20; ++i) pieces += "64\r\n" + std::string(100, 'y') + "\r\n";
  CHECK(status_of(s.ask(post, "Transfer-Encoding: chunked\r\n", pieces + "0\r\n\r\n")) != 200);
  CHECK(status_of(s.ask("GET /" + token + "/" + std::string(100'000, 'a'))) != 200);
  std::string headers;
  for (int i = 0; i < 5000; ++i) headers += "X-" + std::to_string(i) + ": y\r\n";
  CHECK(status_of(s.ask("GET /" + token + "/state", headers)) != 200);
  for (const std::string method : {"DELETE", "PUT", "OPTIONS", "TRACE", "CONNECT", "BREW"})
    CHECK(status_of(s.ask(method + " /" + token + "/state")) == 405);
  CHECK(s.calls == 1);
  CHECK(status_of(s.ask("GET /" + token + "/state")) == 200);
}

TEST_CASE("an address with too many arguments is refused at once and holds no connection") {
  HttpLimits limits;
  limits.connections = 4;
  Server s(limits);
  for (const int count : {64, 65, 500, 2000, 8000})
    for (const std::string argument : {"a", "a=1", "=", "%00=%ff"}) {
      std::string path = "/" + token + "/state?" + argument;
      for (int i = 1; i < count; ++i) path += "&" + argument;
      const int status = status_of(s.ask("GET " + path));
      CHECK(status == (count == 64 ? 200 : 414));
    }
  CHECK(status_of(s.ask("GET /" + token + "/state")) == 200);
}

TEST_CASE("HEAD is answered like GET without a body; a repeated Content-Length is refused") {
  Server s;
  const std::string answer = s.ask("HEAD /" + token + "/state");
  CHECK(status_of(answer) == 200);
  CHECK(answer.find("Content-Length: 11") != answer.npos);
  CHECK(body_of(answer).empty());
  const std::string post = "POST /" + token + "/camera";
  CHECK(status_of(s.ask(post, "Content-Length: 3\r\nContent-Length: 4\r\n", "abcd")) == 400);
  CHECK(status_of(s.ask(post, "Content-Length: 3\r\nTransfer-Encoding: chunked\r\n",
                        "0\r\n\r\n")) == 400);
  CHECK(s.calls == 1);
}

TEST_CASE("malformed HTTP ends the connection, and the next request is answered") {
  Server s;
  for (const std::string& bytes : {std::string("\0\0\0\0\r\n\r\n", 8), std::string("GET\r\n\r\n"),
                                   std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11) +
                                       std::string(300, 'z') + "\r\n\r\n"}) {
    const Client client(s.server.port());
    client.send(bytes);
    CHECK(status_of(client.rest()) != 200);
  }
  CHECK(s.calls == 0);
  CHECK(status_of(s.ask("GET /" + token + "/state")) == 200);
}

TEST_CASE("errors in a handler become HTTP statuses") {
  Server s;
  CHECK(status_of(s.ask("GET /" + token + "/fails")) == 400);
  CHECK(status_of(s.ask("GET /" + token + "/breaks")) == 500);
  CHECK(status_of(s.ask("GET /" + token + "/state")) == 200);
}

TEST_CASE("a client that sends byte by byte is dropped; others are served meanwhile") {
  HttpLimits limits;
  limits.request_seconds = 0.2;
  Server s(limits);
  std::vector<std::unique_ptr<Client>> slow;
  for (int i = 0; i < 8; ++i) slow.push_back(std::make_unique<Client>(s.server.port()));
  bool are_all_gone = false;
  for (int turn = 0; turn < 2000 && !are_all_gone; ++turn) {
    are_all_gone = true;
    for (const auto& c : slow) are_all_gone &= !c->send(turn == 0 ? "GET /" : "a");
    s.server.drop_slow_clients();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (turn == 3) CHECK(status_of(s.ask("GET /" + token + "/state")) == 200);
  }
  CHECK(are_all_gone);
  CHECK(s.calls == 1);
}

TEST_CASE("the number of concurrent connections is limited") {
  HttpLimits limits;
  limits.connections = 4;
  Server s(limits);
  {
    std::vector<std::unique_ptr<Client>> open;
    for (int i = 0; i < 40; ++i) open.push_back(std::make_unique<Client>(s.server.port()));
  }
  // Once they are gone, there is room again.
  int status = 0;
  for (int i = 0; i < 1000 && status != 200; ++i) {
    status = status_of(s.ask("GET /" + token + "/state"));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  CHECK(status == 200);
}

TEST_CASE("the server listens only on this machine's loopback address and reports a port in use") {
  Server s;
  const Client other(s.server.port(), 0x7f000002);  // 127.0.0.2: another address of this machine
  CHECK(!other.is_connected());
  CHECK_THROWS_AS(
      HttpServer(s.server.port(), token, [](const HttpRequest&) { return HttpResponse(); }),
      EnvironmentError);
}

TEST_CASE("tokens have 128 random bits and are compared completely") {
  const std::string a = random_token(), b = random_token();
  CHECK(a.size() == 32);
  CHECK(a.find_first_not_of("0123456789abcdef") == a.npos);
  CHECK(a != b);
  CHECK(is_same_token(a, a));
  CHECK(!is_same_token(a, b));
  CHECK(!is_same_token(a.substr(0, 31), a));
  CHECK(!is_same_token(a + a, a));
  CHECK(!is_same_token("", a));
}
