#pragma once

#include <string>

namespace lightwell {

/// Parts of a COLLADA file.
struct DaeParts {
  std::string asset = R"(<unit meter="1"/><up_axis>Z_UP</up_axis>)";
  std::string effect{};     ///< within <lambert> of the one material, called "paint"
  std::string params{};     ///< before the effect's technique
  std::string libraries{};  ///< further libraries
  std::string nodes = R"(<node id="plate"><instance_geometry url="#square"><bind_material>)"
                      R"(<technique_common><instance_material symbol="m" target="#paint"/>)"
                      R"(</technique_common></bind_material></instance_geometry></node>)";
};

/// A COLLADA file with a unit square in the xy plane, z = 0, front towards +z, and texture
/// coordinates (x, y).
inline std::string square_dae(const DaeParts& parts = {}) {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>)" +
         parts.asset + R"(</asset>
<library_effects><effect id="look"><profile_COMMON>)" +
         parts.params + R"(<technique sid="t"><lambert>)" + parts.effect +
         R"(</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="paint" name="paint"><instance_effect url="#look"/></material></library_materials>
<library_geometries><geometry id="square" name="square"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<source id="t"><float_array id="ta" count="8">0 0 1 0 1 1 0 1</float_array><technique_common>
<accessor source="#ta" count="4" stride="2"><param name="S" type="float"/><param name="T" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist material="m" count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#t" offset="0" set="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist>
</mesh></geometry></library_geometries>)" +
         parts.libraries + R"(
<library_visual_scenes><visual_scene id="scene">)" +
         parts.nodes + R"(</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
)";
}

/// Parts of an FBX file in text.
struct FbxParts {
  std::string settings = R"(P: "UnitScaleFactor", "double", "Number", "",100)";
  std::string place{};     ///< properties of the square's node
  std::string material{};  ///< properties of the material "paint"
  std::string layers{};    ///< elements of the square's layer
  std::string layer{};     ///< references of the layer to them
  std::string objects{};   ///< further objects
  std::string links{};     ///< further connections
};

/// An FBX 7.4 file with a unit square in the xy plane, z = 0, front towards +z.
inline std::string square_fbx(const FbxParts& parts = {}) {
  return R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		)" +
         parts.settings + R"(
	}
}
Objects:  {
	Geometry: 11, "Geometry::square", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,1,0,0,1,1,0,0,1,0
		}
		PolygonVertexIndex: *4 {
			a: 0,1,2,-4
		}
		GeometryVersion: 124
		LayerElementMaterial: 0 {
			Version: 101
			Name: ""
			MappingInformationType: "AllSame"
			ReferenceInformationType: "IndexToDirect"
			Materials: *1 {
				a: 0
			}
		}
)" + parts.layers +
         R"(
		Layer: 0 {
			Version: 100
			LayerElement:  {
				Type: "LayerElementMaterial"
				TypedIndex: 0
			}
)" + parts.layer +
         R"(
		}
	}
	Model: 12, "Model::plate", "Mesh" {
		Version: 232
		Properties70:  {
			)" +
         parts.place + R"(
		}
	}
	Material: 13, "Material::paint", "" {
		Version: 102
		ShadingModel: "phong"
		Properties70:  {
			)" +
         parts.material + R"(
		}
	}
)" + parts.objects +
         R"(
}
Connections:  {
	C: "OO",12,0
	C: "OO",11,12
	C: "OO",13,12
)" + parts.links +
         R"(
}
)";
}

}  // namespace lightwell
