// `troffer view` from start to end.
#include <doctest/doctest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "../annual/stored_folder.h"
#include "../view/client.h"
#include "program.h"

using namespace troffer::test;

namespace test_view_command {

TEST_CASE("view prints its address, and a signal ends it") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  for (const int which : {SIGINT, SIGTERM}) {
    Running program(folder, {"view", scene, "--threads", "1", "--error", "0.001", "--quiet"});
    program.let_work(0.5);
    program.send(which);
    const Finished f = program.wait();
    CHECK(f.status == 130);
    CHECK(f.seconds_after_signal < 5);
    CHECK(f.err.empty());
    CHECK(f.out.rfind("http://127.0.0.1:", 0) == 0);
    CHECK(f.out.size() > 32 + 20);
  }
  CHECK(folder.names() == std::vector<std::string>{"room.pbrt"});
}

namespace {

// Asks a view for another time of day. Returns the status of the answer.
int ask_for_time(const std::string& address, const std::string& time) {
  const std::string scheme = "http://";
  const size_t slash = address.find('/', scheme.size());
  const std::string host = address.substr(scheme.size(), slash - scheme.size());
  const std::string body = "{\"time\":\"" + time + "\"}";
  const Client client(uint16_t(std::stoi(host.substr(host.find(':') + 1))));
  REQUIRE(client.is_connected());
  client.send("POST " + address.substr(slash) + "time HTTP/1.1\r\nHost: " + host +
              "\r\nConnection: close\r\nContent-Length: " + std::to_string(body.size()) +
              "\r\n\r\n" + body);
  return status_of(client.rest());
}

// Returns the page's address, once the program prints it.
std::string address_of(const Running& program) {
  for (int i = 0; i < 6000; ++i) {
    const std::string out = program.output();
    if (out.ends_with('\n')) return out.substr(0, out.size() - 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return "";
}

}  // namespace

TEST_CASE("another time of day relights the loaded scene even if its files are gone") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  folder.write("image.pfm", "PF\n2 1\n-1.0\n" + std::string(24, '\0'));
  const std::string list = folder.write("list.csv", "file,x,y,z\nlamp.ies,0,0,1\n");
  folder.write("lamp.ies",
               "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n100 50\n");
  Running program(folder, {"view", scene, "--at", "48.2,16.4,2026-06-21T12:00+02:00", "--threads",
                           "1", "--environment", folder.path("image.pfm"), "--luminaires", list});
  const std::string address = address_of(program);
  CAPTURE(program.output());
  REQUIRE(!address.empty());
  CHECK(ask_for_time(address, "2026-06-21T13:00+02:00") == 200);
  for (const char* name : {"room.pbrt", "image.pfm", "list.csv", "lamp.ies"})
    std::filesystem::remove(folder.path(name));
  CHECK(ask_for_time(address, "2026-06-21T15:00+02:00") == 200);
  folder.write("room.pbrt", "WorldBegin\nShape");
  CHECK(ask_for_time(address, "2026-06-21T16:00+02:00") == 200);
  CHECK(ask_for_time(address, "2026-06-21") == 400);
  program.send(SIGTERM);
  CHECK(program.wait().status == 130);
}

TEST_CASE("view notes a year of another scene, and shows it") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const troffer::test::StoredFolder year;
  Running program(folder, {"view", scene, "--annual", year.path(), "--threads", "1"});
  const std::string address = address_of(program);
  CAPTURE(program.output());
  REQUIRE(!address.empty());
  program.send(SIGTERM);
  const Finished f = program.wait();
  CHECK(f.status == 130);
  CHECK(f.err.find("two.gltf, not room.pbrt") != std::string::npos);
  CHECK(f.err.find("5 sensors") != std::string::npos);
}

TEST_CASE("view refuses what it cannot show before it opens a page") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", lit_floor_pbrt);
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"view", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished f = run_program(folder, arguments);
    CHECK(f.out.empty());
    CHECK(f.error_lines().size() == 1);
    return f.status;
  };
  CHECK(run({folder.path("none.gltf")}) == 1);
  CHECK(run({scene, "--camera", "none"}) == 2);
  CHECK(run({scene, "--size", "0x10"}) == 2);
  CHECK(run({scene, "--size", "10x10x"}) == 2);
  CHECK(run({scene, "--error", "nan"}) == 2);
  CHECK(run({scene, "--method", "magic"}) == 2);
  CHECK(run({scene, "--at", "48,16,yesterday"}) == 2);
  CHECK(run({scene, "--annual", folder.path("none")}) == 1);
  CHECK(run({scene, "--annual", folder.path("")}) == 1);
}

}  // namespace test_view_command
