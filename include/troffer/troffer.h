/// @file
/// Includes the whole public interface: scenes, pictures, measurements and years of daylight.
#pragma once

#include "troffer/annual.h"
#include "troffer/error.h"
#include "troffer/image.h"
#include "troffer/light.h"
#include "troffer/material.h"
#include "troffer/measure.h"
#include "troffer/render.h"
#include "troffer/scene.h"
#include "troffer/types.h"

/// Physically based rendering of rooms.
namespace troffer {
/// The public interface: load or build a Scene, then call render(), measure()
/// and annual().
namespace api {}
}  // namespace troffer
