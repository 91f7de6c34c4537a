// Converts keyword arguments by pybind11's rules, with TypeError for wrong types. Tables map names
// of arguments to members of options. Used by the functions that take many keywords.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "troffer/types.h"

namespace troffer::bindings {

// Converts the value to a T. Throws TypeError that names the argument.
template <class T>
T taken(const pybind11::handle& value, const std::string& name) {
  pybind11::detail::make_caster<T> caster;
  if (!caster.load(value, true))
    throw pybind11::type_error(
        "argument '" + name + "' has the wrong type: " + pybind11::repr(value).cast<std::string>());
  return pybind11::detail::cast_op<T>(std::move(caster));
}

// Accepts True and False only, not other objects with a truth value.
template <>
bool taken<bool>(const pybind11::handle& value, const std::string& name);

// Accepts three numbers, or one for all channels.
api::Color color_taken(const pybind11::handle& value, const std::string& name);

// One function per argument, which sets a member of the options.
template <class Options>
using ArgumentTable = std::map<std::string, std::function<void(Options&, const pybind11::handle&)>>;

// Returns the entry of a table that sets a member by taken().
template <class Options, class T>
typename ArgumentTable<Options>::value_type argument(const std::string& name, T Options::*member) {
  return {name, [name, member](Options& o, const pybind11::handle& value) {
            o.*member = taken<T>(value, name);
          }};
}

// Sets the option of that name. Returns false if the table does not have the name.
template <class Options>
bool set_argument(const ArgumentTable<Options>& table, const std::string& name,
                  const pybind11::handle& value, Options& options) {
  const auto entry = table.find(name);
  if (entry == table.end()) return false;
  entry->second(options, value);
  return true;
}

// Throws TypeError for an argument that a function does not have.
[[noreturn]] void fail_unknown(const char* function, const std::string& name);

}  // namespace troffer::bindings
