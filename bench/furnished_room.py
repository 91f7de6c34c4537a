"""A furnished office as an HBJSON model, for bench/annual.

It is 6 x 5 x 2.8 m, with a window to the south and one to the west, which form one window group of
two states: open, and closed by slats outside. A desk, a cupboard and a screen wall stand in it.
"""
WIDTH, DEPTH, HEIGHT = 6, 5, 2.8
SLATS = 12  # per window
GROUP, PANE = 'Blinds', 0.75
REFLECTANCES = {'slat': 0.6, 'desk': 0.45, 'cupboard': 0.3, 'screen': 0.65}
GRID, PLANE = 'Plane', 0.85  # of the sensors: name, height in m
CUPBOARD = ((4.9, 3.6), (5.8, 4.8), 1.9)  # corners in plan, height


def polygon(corners):
    return {'type': 'Face3D', 'boundary': [list(map(float, c)) for c in corners]}


def slats(name, left, right, sill, head, place):
    """Slats at 45 degrees. place(along, out): x and y of a point before the window."""
    pitch = (head - sill) / SLATS
    for k in range(SLATS):
        low = sill + k * pitch
        yield {'type': 'StateGeometryAbridged', 'identifier': f'{name}_slat{k}',
               'modifier': 'slat', 'geometry': polygon([
                   (*place(left, 0.06), low + pitch), (*place(left, 0.06 + pitch), low),
                   (*place(right, 0.06 + pitch), low), (*place(right, 0.06), low + pitch)])}


def aperture(name, left, right, sill, head, place):
    corners = [(*place(left, 0), head), (*place(left, 0), sill), (*place(right, 0), sill),
               (*place(right, 0), head)]
    return {'type': 'Aperture', 'identifier': name, 'display_name': name,
            'geometry': polygon(corners), 'boundary_condition': {'type': 'Outdoors'},
            'properties': {'type': 'AperturePropertiesAbridged', 'radiance': {
                'type': 'ApertureRadiancePropertiesAbridged', 'modifier': 'pane',
                'dynamic_group_identifier': GROUP,
                'states': [{'type': 'RadianceSubFaceStateAbridged'},
                           {'type': 'RadianceSubFaceStateAbridged',
                            'shades': list(slats(name, left, right, sill, head, place))}]}}}


def face(name, kind, corners, apertures=()):
    return {'type': 'Face', 'identifier': name, 'display_name': name, 'face_type': kind,
            'geometry': polygon(corners), 'boundary_condition': {'type': 'Outdoors'},
            'apertures': list(apertures), 'properties': {
                'type': 'FacePropertiesAbridged',
                'radiance': {'type': 'FaceRadiancePropertiesAbridged'}}}


def shade(name, modifier, corners):
    return {'type': 'Shade', 'identifier': name, 'display_name': name,
            'geometry': polygon(corners), 'is_detached': False,
            'properties': {'type': 'ShadePropertiesAbridged', 'radiance': {
                'type': 'ShadeRadiancePropertiesAbridged', 'modifier': modifier}}}


def box(name, modifier, low, high, base, top):
    """Five sides of a box on the floor or above it."""
    (a, b), (c, d) = low, high
    ring = [(a, b), (c, b), (c, d), (a, d)]
    yield shade(f'{name}_top', modifier, [(*p, top) for p in ring])
    for k in range(4):
        p, q = ring[k], ring[(k + 1) % 4]
        yield shade(f'{name}_{k}', modifier, [(*p, base), (*q, base), (*q, top), (*p, top)])


def furniture():
    return [*box('desk', 'desk', (1.5, 1.2), (3.1, 2), 0.7, 0.74),
            *box('cupboard', 'cupboard', CUPBOARD[0], CUPBOARD[1], 0, CUPBOARD[2]),
            shade('screen', 'screen', [(3.5, 2.6, 0), (3.5, 4.2, 0), (3.5, 4.2, 1.5),
                                       (3.5, 2.6, 1.5)])]


def sensors():
    """Three by four sensors, but for the one in the cupboard."""
    for i in range(3):
        for k in range(4):
            x, y = 2 * i + 1, 1.25 * k + 0.6
            (a, b), (c, d), _ = CUPBOARD
            if not (a <= x <= c and b <= y <= d):
                yield {'pos': [x, y, PLANE], 'dir': [0, 0, 1]}


def model():
    """Returns the model. y is north."""
    ring = [(0, 0), (WIDTH, 0), (WIDTH, DEPTH), (0, DEPTH)]
    walls = [[(*a, HEIGHT), (*a, 0), (*b, 0), (*b, HEIGHT)]
             for a, b in zip(ring, ring[1:] + ring[:1])]
    south = aperture('South', 1, 4.5, 0.8, 2.4, lambda along, out: (along, -out))
    west = aperture('West', 1.5, 3.5, 1, 2.2, lambda along, out: (-out, DEPTH - along))
    faces = [face(f'Wall{k}', 'Wall', w, {0: [south], 3: [west]}.get(k, ()))
             for k, w in enumerate(walls)]
    faces.append(face('Floor', 'Floor', [(*p, 0) for p in reversed(ring)]))
    faces.append(face('Ceiling', 'RoofCeiling', [(*p, HEIGHT) for p in ring]))
    modifiers = [{'type': 'Glass', 'identifier': 'pane', 'modifier': None, 'dependencies': [],
                  'refraction_index': None, **{f'{c}_transmissivity': PANE for c in 'rgb'}}]
    for name, r in REFLECTANCES.items():
        modifiers.append({'type': 'Plastic', 'identifier': name, 'specularity': 0.0,
                          'roughness': 0.0, 'modifier': None, 'dependencies': [],
                          **{f'{c}_reflectance': r for c in 'rgb'}})
    grid = {'type': 'SensorGrid', 'identifier': GRID, 'sensors': list(sensors())}
    return {'type': 'Model', 'identifier': 'Office', 'display_name': 'Office', 'units': 'Meters',
            'version': '1.58.0', 'tolerance': 0.01, 'angle_tolerance': 1.0,
            'orphaned_shades': furniture(),
            'rooms': [{'type': 'Room', 'identifier': 'Room', 'display_name': 'Room', 'faces': faces,
                       'properties': {'type': 'RoomPropertiesAbridged', 'radiance': {
                           'type': 'RoomRadiancePropertiesAbridged'}}}],
            'properties': {'type': 'ModelProperties', 'radiance': {
                'type': 'ModelRadianceProperties', 'modifiers': modifiers, 'modifier_sets': [],
                'sensor_grids': [grid], 'views': []}}}
