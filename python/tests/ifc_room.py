"""A room of 5 m x 4 m x 3 m as an IFC model, written by IfcOpenShell."""

import ifcopenshell
import ifcopenshell.api.aggregate as aggregate
import ifcopenshell.api.context as context
import ifcopenshell.api.feature as feature
import ifcopenshell.api.geometry as geometry
import ifcopenshell.api.material as material
import ifcopenshell.api.owner as owner
import ifcopenshell.api.owner.settings
import ifcopenshell.api.project as project
import ifcopenshell.api.pset as pset
import ifcopenshell.api.root as root
import ifcopenshell.api.spatial as spatial
import ifcopenshell.api.style as style
import ifcopenshell.api.type as types
import ifcopenshell.api.unit as unit
import numpy as np

WALL, CEILING = 0.5, 0.75
"""Reflectances by Pset_MaterialOptical."""
FLOOR_COLOUR = 0.5
"""sRGB of the style of the floor."""
LAMPS = [(1.25, 2.0, 2.8), (3.75, 2.0, 2.8)]


class Model:
    """A building in the making. `unit_metres`: metres of the file's unit of length."""

    def __init__(self, schema="IFC4", unit_metres=1.0):
        self.file = project.create_file(version=schema)
        if schema == "IFC2X3":  # whose elements have owners
            owner.settings.get_user = lambda file: file.createIfcPersonAndOrganization(
                file.createIfcPerson(FamilyName="Test"), file.createIfcOrganization(Name="Test")
            )
            owner.settings.get_application = lambda file: file.createIfcApplication(
                file.createIfcOrganization(Name="Test"), "1", "test", "test"
            )
        self.scale = 1.0 / unit_metres
        root.create_entity(self.file, ifc_class="IfcProject", name="test")
        length = unit.add_si_unit(self.file, unit_type="LENGTHUNIT", prefix="MILLI" if unit_metres == 1e-3 else None)
        unit.assign_unit(self.file, units=[length])
        model = context.add_context(self.file, context_type="Model")
        self.body = context.add_context(
            self.file, context_type="Model", context_identifier="Body", target_view="MODEL_VIEW", parent=model
        )
        self.storey = root.create_entity(self.file, ifc_class="IfcBuildingStorey", name="ground floor")
        aggregate.assign_object(self.file, products=[self.storey], relating_object=self.file.by_type("IfcProject")[0])

    def box(self, ifc_class, name, low, high, origin=(0, 0, 0), turn=None):
        """An element whose shape is a box, in coordinates of its placement, metres."""
        low, high = np.array(low, float), np.array(high, float)
        profile = self.file.createIfcRectangleProfileDef(
            "AREA",
            None,
            self.file.createIfcAxis2Placement2D(
                self.file.createIfcCartesianPoint([float(v) * self.scale for v in 0.5 * (low + high)[:2]])
            ),
            *((high - low)[:2] * self.scale).tolist(),
        )
        return self._extruded(ifc_class, name, profile, low[2], high[2], origin, turn)

    def prism(self, ifc_class, name, outline, low, high, holes=()):
        """An element that stands on a polygon, with holes, between two heights, metres."""

        def line(corners):
            closed = [*corners, corners[0]]
            points = [self.file.createIfcCartesianPoint([float(v) * self.scale for v in xy]) for xy in closed]
            return self.file.createIfcPolyline(points)

        if holes:
            profile = self.file.createIfcArbitraryProfileDefWithVoids("AREA", None, line(outline), [line(h) for h in holes])
        else:
            profile = self.file.createIfcArbitraryClosedProfileDef("AREA", None, line(outline))
        return self._extruded(ifc_class, name, profile, low, high, (0, 0, 0), None)

    def _extruded(self, ifc_class, name, profile, low, high, origin, turn):
        element = root.create_entity(self.file, ifc_class=ifc_class, name=name)
        solid = self.file.createIfcExtrudedAreaSolid(
            profile,
            self.file.createIfcAxis2Placement3D(
                self.file.createIfcCartesianPoint((0.0, 0.0, float(low) * self.scale))
            ),
            self.file.createIfcDirection((0.0, 0.0, 1.0)),
            float(high - low) * self.scale,
        )
        shape = self.file.createIfcShapeRepresentation(self.body, "Body", "SweptSolid", [solid])
        geometry.assign_representation(self.file, product=element, representation=shape)
        self.place(element, origin, turn)
        return element

    def place(self, element, origin, turn=None):
        matrix = np.eye(4)
        matrix[:3, :3] = np.eye(3) if turn is None else turn
        matrix[:3, 3] = origin
        geometry.edit_object_placement(self.file, product=element, matrix=matrix, is_si=True)
        if not element.is_a("IfcOpeningElement"):
            if element.is_a("IfcSpace"):
                aggregate.assign_object(self.file, products=[element], relating_object=self.storey)
            else:
                spatial.assign_container(self.file, products=[element], relating_structure=self.storey)

    def light_source(self, name, origin, source, turn=None):
        """A light fixture without a body, whose shape is a light source."""
        fixture_class = "IfcFlowTerminal" if self.file.schema == "IFC2X3" else "IfcLightFixture"
        element = root.create_entity(self.file, ifc_class=fixture_class, name=name)
        shape = self.file.createIfcShapeRepresentation(self.body, "Lighting", "LightSource", [source])
        element.Representation = self.file.createIfcProductDefinitionShape(None, None, [shape])
        self.place(element, origin, turn)
        return element

    def goniometric(self, data, flux=1000.0, at=(0, 0, 0)):
        """A goniometric light source at a place of its fixture, metres."""
        file = self.file
        place = file.createIfcAxis2Placement3D(file.createIfcCartesianPoint([float(v) * self.scale for v in at]))
        white = file.createIfcColourRgb(None, 1.0, 1.0, 1.0)
        return file.createIfcLightSourceGoniometric(
            None, white, None, None, place, None, 4000.0, flux, "LIGHTEMITTINGDIODE", data
        )

    def distribution(self, planes, kind="TYPE_C"):
        """Intensities of planes: {angle: (angles, intensities)}, degrees, as the file has radians."""
        data = [
            self.file.createIfcLightDistributionData(float(np.radians(plane)), np.radians(angles).tolist(), list(values))
            for plane, (angles, values) in planes.items()
        ]
        return self.file.createIfcLightIntensityDistribution(kind, data)

    def properties(self, element, name, values):
        """Gives an element a property set."""
        made = pset.add_pset(self.file, product=element, name=name)
        pset.edit_pset(self.file, pset=made, properties=values)

    def optical(self, elements, name, reflectance, **more):
        """Gives elements a material, from IFC4 on with this visible reflectance and other properties."""
        made = material.add_material(self.file, name=name)
        material.assign_material(self.file, products=elements, material=made)
        if self.file.schema == "IFC2X3":
            return
        values = pset.add_pset(self.file, product=made, name="Pset_MaterialOptical")
        pset.edit_pset(self.file, pset=values, properties={"VisibleReflectanceFront": reflectance, **more})

    def coloured(self, element, name, colour, transparency=0.0):
        """Gives an element a style of this colour."""
        made = style.add_style(self.file, name=name)
        style.add_surface_style(
            self.file,
            style=made,
            ifc_class="IfcSurfaceStyleRendering",
            attributes={
                "SurfaceColour": {"Name": None, "Red": colour, "Green": colour, "Blue": colour},
                "Transparency": transparency,
                "ReflectanceMethod": "NOTDEFINED",
            },
        )
        for representation in element.Representation.Representations:
            style.assign_representation_styles(self.file, shape_representation=representation, styles=[made])


def room(**options):
    """The room: walls and slabs 0.2 m thick around it, two light fixtures, and a space."""
    model = Model(**options)
    floor = model.box("IfcSlab", "floor", (-0.2, -0.2, -0.2), (5.2, 4.2, 0))
    ceiling = model.box("IfcSlab", "ceiling", (-0.2, -0.2, 3), (5.2, 4.2, 3.2))
    walls = [
        model.box("IfcWall", "south", (0, 0, 0), (5, 0.2, 3), origin=(0, -0.2, 0)),
        model.box("IfcWall", "north", (0, 0, 0), (5, 0.2, 3), origin=(0, 4, 0)),
        # A wall along its own x axis, turned by a quarter.
        model.box("IfcWall", "west", (0, 0, 0), (4.4, 0.2, 3), origin=(0, -0.2, 0), turn=[[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
        model.box("IfcWall", "east", (0, 0, 0), (0.2, 4.4, 3), origin=(5, -0.2, 0)),
    ]
    model.optical(walls, "paint", WALL)
    model.optical([ceiling], "plaster", CEILING)
    model.coloured(floor, "carpet", FLOOR_COLOUR)
    kind = root.create_entity(model.file, ifc_class="IfcLightFixtureType", name="Panel 600")
    fixture_class = "IfcFlowTerminal" if model.file.schema == "IFC2X3" else "IfcLightFixture"
    for number, place in enumerate(LAMPS):
        lamp = model.box(fixture_class, f"lamp {number}", (-0.3, -0.3, 0), (0.3, 0.3, 0.1), origin=place)
        types.assign_type(model.file, related_objects=[lamp], relating_type=kind)
    model.box("IfcSpace", "office", (0, 0, 0), (5, 4, 3))
    return model


def cut(model, wall, low, high):
    """Cuts a box, in world coordinates, out of a wall of a model."""
    element = next(each for each in model.file.by_type("IfcWall") if each.Name == wall)
    opening = model.box("IfcOpeningElement", "opening", low, high)
    feature.add_feature(model.file, feature=opening, element=element)
