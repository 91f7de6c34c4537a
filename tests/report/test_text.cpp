// Names with any contents in pages and tables.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "base/random.h"
#include "report/false_colour.h"
#include "report/html_text.h"
#include "report/sha256.h"

using namespace troffer;

namespace {

std::vector<uint8_t> bytes_of(const std::string& s) {
  return {s.begin(), s.end()};
}

}  // namespace

TEST_CASE("SHA-256 of FIPS 180-4's examples, and around the ends of blocks") {
  CHECK(sha256({}) == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256(bytes_of("abc")) ==
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256(bytes_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")) ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256(bytes_of(std::string(1'000'000, 'a'))) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  CHECK(sha256(bytes_of(std::string(55, 'a'))) ==
        "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318");
  CHECK(sha256(bytes_of(std::string(64, 'a'))) ==
        "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb");
}

TEST_CASE("names cannot break out of the surrounding markup") {
  CHECK(html_text("<script>alert(1)</script>") == "&lt;script&gt;alert(1)&lt;/script&gt;");
  CHECK(html_text("\"><img src=x onerror='a&b'>") ==
        "&quot;&gt;&lt;img src=x onerror=&#39;a&amp;b&#39;&gt;");
  CHECK(html_text("Büro 3, Ø") == "Büro 3, Ø");
  const std::string no = "\xef\xbf\xbd";
  CHECK(html_text(std::string("a\0b\x7f", 4)) == "a" + no + "b" + no);
  CHECK(html_text("\xc3") == no);  // truncated
  CHECK(html_text("\xc0\xbc"
                  "script") == no + no + "script");  // overlong <
  CHECK(html_text("\xed\xa0\x80") == no + no + no);  // a surrogate
  CHECK(html_text("a\xe2\x80\xae"
                  "b") == "a" + no + "b");  // changes the text direction
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    std::string s;
    for (int k = 0; k < 20; ++k) s += char(random.next_u32());
    const std::string t = html_text(s);
    CHECK(t.find_first_of("<>\"'") == std::string::npos);
    CHECK(html_text(t).find(no + no + no + no + no + no + no + no + no + no + no + no + no + no +
                            no + no + no + no + no + no + no) == std::string::npos);
  }
}

TEST_CASE("fields of tables are quoted and cannot be formulas") {
  CHECK(csv_field("desk") == "\"desk\"");
  CHECK(csv_field("a\"b,c\n") == "\"a\"\"b,c \"");
  CHECK(csv_field("=1+1") == "\"'=1+1\"");
  CHECK(csv_field("@SUM(A1)") == "\"'@SUM(A1)\"");
}

TEST_CASE("base64 follows RFC 4648") {
  CHECK(base64(bytes_of("")).empty());
  CHECK(base64(bytes_of("f")) == "Zg==");
  CHECK(base64(bytes_of("fo")) == "Zm8=");
  CHECK(base64(bytes_of("foobar")) == "Zm9vYmFy");
}

TEST_CASE("numbers are rounded to two digits of their errors") {
  CHECK(with_error(512.345, 3.21) == "512.3 ± 3.2");
  CHECK(with_error(512.345, 32.1) == "512 ± 32");
  CHECK(with_error(0.61234, 0.0123) == "0.612 ± 0.012");
  CHECK(with_error(31.296, 0.019) == "31.30 ± 0.02");
  CHECK(with_error(0, 0.5) == "0.00 ± 0.50");
  CHECK(with_error(512.345, 0) == "512");
  CHECK(short_number(0.1234) == "0.123");
}

TEST_CASE("scales have round values and colours of rising lightness") {
  CHECK(round_values(1, 1000, 20, true) ==
        std::vector<double>{1, 2, 5, 10, 20, 50, 100, 200, 500, 1000});
  CHECK(round_values(180, 620, 5, false) == std::vector<double>{200, 300, 400, 500, 600});
  CHECK(round_values(0, 1, 5, true).empty());
  CHECK(round_values(5, 5, 5, false).empty());
  double last = -1;
  for (int i = 0; i <= 100; ++i) {
    const Rgb8 c = false_colour(i / 100.0);
    const double y = 0.2126 * double(linear_from_srgb(float(c[0]) / 255)) +
                     0.7152 * double(linear_from_srgb(float(c[1]) / 255)) +
                     0.0722 * double(linear_from_srgb(float(c[2]) / 255));
    CHECK(y > last - 1e-4);
    last = y;
  }
}
