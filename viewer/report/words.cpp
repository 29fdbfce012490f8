#include "viewer/report/words.h"

#include <array>
#include <string_view>

namespace lightwell {
namespace {

struct Entry {
  Word word;
  std::array<const char*, language_count> texts;  ///< in the order of Language
};

constexpr std::array entries = {
    Entry{Word::project, {"Project", "Projekt", "Projet", "Proyecto"}},
    Entry{Word::client, {"Client", "Auftraggeber", "Maître d’ouvrage", "Cliente"}},
    Entry{Word::author, {"Author", "Bearbeitung", "Auteur", "Autor"}},
    Entry{Word::date, {"Date", "Datum", "Date", "Fecha"}},
    Entry{Word::remarks, {"Remarks", "Bemerkungen", "Remarques", "Observaciones"}},
    Entry{Word::computed_with, {"Computed with", "Berechnet mit", "Calculé avec", "Calculado con"}},
    Entry{Word::view,
          {"View ‘{0}’, by {1}.", "Ansicht „{0}“, {1}.", "Vue « {0} », en {1}.",
           "Vista «{0}», con {1}."}},

    Entry{Word::electric_light,
          {"electric light", "Kunstlicht", "lumière électrique", "luz eléctrica"}},
    Entry{Word::daylight, {"daylight", "Tageslicht", "lumière naturelle", "luz natural"}},
    Entry{Word::electric_and_daylight,
          {"electric light and daylight", "Kunst- und Tageslicht",
           "lumière électrique et naturelle", "luz eléctrica y natural"}},
    Entry{Word::both, {"both", "zusammen", "ensemble", "total"}},
    Entry{Word::sky, {"sky", "Himmel", "ciel", "cielo"}},
    // The names of skies in scene files.
    Entry{Word::sky_overcast,
          {"CIE overcast", "bedeckter Himmel nach CIE", "ciel couvert CIE", "cielo cubierto CIE"}},
    Entry{Word::sky_clear,
          {"CIE clear", "klarer Himmel nach CIE", "ciel clair CIE", "cielo despejado CIE"}},
    Entry{Word::sky_uniform,
          {"uniform", "gleichmäßiger Himmel", "ciel uniforme", "cielo uniforme"}},
    Entry{Word::content_electric,
          {"All figures are of electric light: the scene has no daylight, or it is switched off.",
           "Alle Werte gelten für Kunstlicht: Die Szene hat kein Tageslicht, oder es ist "
           "ausgeschaltet.",
           "Toutes les valeurs sont celles de la lumière électrique : la scène n’a pas de lumière "
           "naturelle, ou celle-ci est désactivée.",
           "Todos los valores son de luz eléctrica: la escena no tiene luz natural o está "
           "desactivada."}},
    Entry{Word::content_daylight,
          {"All figures are of daylight ({0}): there is no electric light.",
           "Alle Werte gelten für Tageslicht ({0}): Es gibt kein Kunstlicht.",
           "Toutes les valeurs sont celles de la lumière naturelle ({0}) : il n’y a pas de lumière "
           "électrique.",
           "Todos los valores son de luz natural ({0}): no hay luz eléctrica."}},
    Entry{Word::content_apart,
          {"Electric light and daylight ({0}) were measured each by itself; ‘both’ is their sum.",
           "Kunstlicht und Tageslicht ({0}) wurden getrennt berechnet; „zusammen“ ist ihre Summe.",
           "La lumière électrique et la lumière naturelle ({0}) sont calculées séparément ; "
           "« ensemble » est leur somme.",
           "La luz eléctrica y la luz natural ({0}) se calcularon por separado; «total» es su "
           "suma."}},
    Entry{
        Word::content_together,
        {"<b>All figures contain electric light and daylight ({0}) together</b>, since the "
         "solution does not keep them apart; the maintenance factor multiplies both. A solution "
         "by ‘lightwell solve’ without ‘--channels off’ tells them apart.",
         "<b>Alle Werte enthalten Kunstlicht und Tageslicht ({0}) zusammen</b>, da die Lösung sie "
         "nicht trennt; der Wartungsfaktor gilt für beide. Eine Lösung von „lightwell solve“ ohne "
         "„--channels off“ trennt sie.",
         "<b>Toutes les valeurs contiennent ensemble la lumière électrique et la lumière naturelle "
         "({0})</b>, car la solution ne les sépare pas ; le facteur de maintenance s’applique aux "
         "deux. Une solution de « lightwell solve » sans « --channels off » les sépare.",
         "<b>Todos los valores contienen juntas la luz eléctrica y la luz natural ({0})</b>, pues "
         "la solución no las separa; el factor de mantenimiento se aplica a ambas. Una solución de "
         "«lightwell solve» sin «--channels off» las separa."}},
    Entry{
        Word::maintained,
        {"Electric light is maintained: initial values times a maintenance factor of {0}.",
         "Kunstlicht: Wartungswerte, das sind Anfangswerte mal Wartungsfaktor {0}.",
         "Lumière électrique : valeurs à maintenir, soit les valeurs initiales multipliées par un "
         "facteur de maintenance de {0}.",
         "Luz eléctrica mantenida: valores iniciales multiplicados por un factor de mantenimiento "
         "de {0}."}},
    Entry{Word::new_lamps,
          {"(New lamps; ‘--maintenance’ sets another factor.)",
           "(Neuanlage; „--maintenance“ setzt einen anderen Faktor.)",
           "(Installation neuve ; « --maintenance » fixe un autre facteur.)",
           "(Instalación nueva; «--maintenance» fija otro factor.)"}},

    Entry{Word::results, {"Results", "Ergebnisse", "Résultats", "Resultados"}},
    Entry{Word::illuminance, {"Illuminance", "Beleuchtungsstärke", "Éclairement", "Iluminancia"}},
    Entry{
        Word::illuminance_means,
        {"E<sub>m</sub> is the mean illuminance over the points of a grid, E<sub>min</sub> and "
         "E<sub>max</sub> are the least and the greatest, and the uniformity is U<sub>0</sub> = "
         "E<sub>min</sub>/E<sub>m</sub>. The ± beside a value is the whole error, with odds of "
         "about 19 to 1.",
         "E<sub>m</sub> ist die mittlere Beleuchtungsstärke über die Punkte eines Rasters, "
         "E<sub>min</sub> und E<sub>max</sub> sind der kleinste und der größte Wert, die "
         "Gleichmäßigkeit ist U<sub>0</sub> = E<sub>min</sub>/E<sub>m</sub>. Das ± neben einem "
         "Wert ist der gesamte Fehler mit einer Wahrscheinlichkeit von etwa 95 %.",
         "E<sub>m</sub> est l’éclairement moyen sur les points d’une grille, E<sub>min</sub> et "
         "E<sub>max</sub> sont les valeurs minimale et maximale, et l’uniformité est U<sub>0</sub> "
         "= E<sub>min</sub>/E<sub>m</sub>. Le ± à côté d’une valeur est l’erreur totale, avec une "
         "probabilité d’environ 95 %.",
         "E<sub>m</sub> es la iluminancia media sobre los puntos de una cuadrícula, "
         "E<sub>min</sub> y E<sub>max</sub> son los valores mínimo y máximo, y la uniformidad es "
         "U<sub>0</sub> = E<sub>min</sub>/E<sub>m</sub>. El ± junto a un valor es el error total, "
         "con una probabilidad de cerca del 95 %."}},
    Entry{
        Word::calculation_surface,
        {"calculation surface", "Berechnungsfläche", "surface de calcul", "superficie de cálculo"}},
    Entry{Word::mean_lux,
          {"E<sub>m</sub>, lx", "E<sub>m</sub>, lx", "E<sub>m</sub>, lx", "E<sub>m</sub>, lx"}},
    Entry{Word::least_lux,
          {"E<sub>min</sub>, lx", "E<sub>min</sub>, lx", "E<sub>min</sub>, lx",
           "E<sub>min</sub>, lx"}},
    Entry{Word::greatest_lux,
          {"E<sub>max</sub>, lx", "E<sub>max</sub>, lx", "E<sub>max</sub>, lx",
           "E<sub>max</sub>, lx"}},
    Entry{Word::uniformity, {"U<sub>0</sub>", "U<sub>0</sub>", "U<sub>0</sub>", "U<sub>0</sub>"}},
    Entry{Word::area, {"area, m²", "Fläche, m²", "aire, m²", "área, m²"}},
    Entry{Word::points, {"points", "Punkte", "points", "puntos"}},
    Entry{Word::power_density,
          {"Installed power density", "Installierte Leistungsdichte",
           "Densité de puissance installée", "Densidad de potencia instalada"}},
    Entry{Word::watts_per_area, {"W/m²", "W/m²", "W/m²", "W/m²"}},
    Entry{Word::per_hundred_lux,
          {"W/m² per 100 lx of electric light", "W/m² je 100 lx Kunstlicht",
           "W/m² pour 100 lx de lumière électrique", "W/m² por 100 lx de luz eléctrica"}},
    Entry{Word::per_hundred_lux_unknown,
          {"W/m² per 100 lx is not known, since electric light is not.",
           "W/m² je 100 lx ist nicht bekannt, da das Kunstlicht nicht bekannt ist.",
           "W/m² pour 100 lx n’est pas connu, car la lumière électrique ne l’est pas.",
           "W/m² por 100 lx no se conoce, pues no se conoce la luz eléctrica."}},
    Entry{Word::unified_glare_rating,
          {"Unified glare rating of observers", "Blendung der Beobachter (UGR)",
           "Éblouissement des observateurs (UGR)", "Deslumbramiento de los observadores (UGR)"}},

    Entry{Word::luminaires, {"Luminaires", "Leuchten", "Luminaires", "Luminarias"}},
    Entry{Word::no_luminaires,
          {"No luminaires; the light is that of sky and sun.",
           "Keine Leuchten; das Licht ist das von Himmel und Sonne.",
           "Aucun luminaire ; la lumière est celle du ciel et du soleil.",
           "Sin luminarias; la luz es la del cielo y del sol."}},
    Entry{Word::name, {"name", "Name", "nom", "nombre"}},
    Entry{Word::luminaire, {"luminaire", "Leuchte", "luminaire", "luminaria"}},
    Entry{Word::number, {"number", "Anzahl", "nombre", "número"}},
    Entry{Word::flux, {"flux, lm", "Lichtstrom, lm", "flux, lm", "flujo, lm"}},
    Entry{Word::power, {"power, W", "Leistung, W", "puissance, W", "potencia, W"}},
    Entry{Word::efficacy, {"lm/W", "lm/W", "lm/W", "lm/W"}},
    Entry{Word::all, {"all", "alle", "total", "total"}},
    Entry{Word::count_of,
          {"{0} of ‘{1}’, {2}", "{0} × „{1}“, {2}", "{0} × « {1} », {2}", "{0} × «{1}», {2}"}},
    Entry{Word::flux_of_table,
          {"Flux of the table {0} lm", "Lichtstrom der Tabelle {0} lm", "Flux de la table {0} lm",
           "Flujo de la tabla {0} lm"}},
    Entry{Word::flux_of_lamps,
          {", of its lamps by the label {0} lm", ", der Lampen laut Angabe {0} lm",
           ", des lampes selon l’étiquette {0} lm", ", de las lámparas según la etiqueta {0} lm"}},
    Entry{Word::flux_in_scene,
          {"; in this scene {0} lm each", "; in dieser Szene je {0} lm",
           " ; dans cette scène {0} lm chacun", "; en esta escena {0} lm cada una"}},
    Entry{Word::watts_each, {"{0} W each", "je {0} W", "{0} W chacun", "{0} W cada una"}},
    Entry{Word::opening,
          {"Luminous opening {0} mm × {1} mm", "Leuchtende Fläche {0} mm × {1} mm",
           "Ouverture lumineuse {0} mm × {1} mm", "Apertura luminosa {0} mm × {1} mm"}},
    Entry{Word::round_opening, {", round", ", rund", ", ronde", ", redonda"}},
    Entry{Word::curve,
          {"Curve: cd per 1000 lm, C0–C180 solid, C90–C270 dashed",
           "Kurve: cd je 1000 lm, C0–C180 durchgezogen, C90–C270 gestrichelt",
           "Courbe : cd pour 1000 lm, C0–C180 en trait plein, C90–C270 en tirets",
           "Curva: cd por 1000 lm, C0–C180 continua, C90–C270 discontinua"}},

    Entry{Word::height_above,
          {"{0} m above the surface.", "{0} m über der Fläche.", "{0} m au-dessus de la surface.",
           "{0} m sobre la superficie."}},
    Entry{Word::without_margin,
          {"Without a margin of {0} m.", "Ohne einen Rand von {0} m.", "Sans une bande de {0} m.",
           "Sin una franja de {0} m."}},
    Entry{Word::grid_size,
          {"{0} m × {1} m, a point every {2} m × {3} m.",
           "{0} m × {1} m, ein Punkt alle {2} m × {3} m.",
           "{0} m × {1} m, un point tous les {2} m × {3} m.",
           "{0} m × {1} m, un punto cada {2} m × {3} m."}},
    Entry{
        Word::cut_above_surface,
        {"Walls are cut {0} m off the surface; lines of equal illuminance in lx.",
         "Wände sind {0} m über der Fläche geschnitten; Linien gleicher Beleuchtungsstärke in lx.",
         "Les murs sont coupés à {0} m de la surface ; courbes isolux en lx.",
         "Los muros se cortan a {0} m de la superficie; curvas isolux en lx."}},
    Entry{Word::cut_above_surface_below,
          {"Walls are cut {0} m off the surface below; lines of equal illuminance in lx.",
           "Wände sind {0} m über der Fläche darunter geschnitten; Linien gleicher "
           "Beleuchtungsstärke in lx.",
           "Les murs sont coupés à {0} m de la surface au-dessous ; courbes isolux en lx.",
           "Los muros se cortan a {0} m de la superficie de abajo; curvas isolux en lx."}},
    Entry{Word::plan_caption,
          {"<b>{0}</b>: E<sub>m</sub> {1} lx, E<sub>min</sub> {2} lx, E<sub>max</sub> {3} lx, "
           "U<sub>0</sub> {4}",
           "<b>{0}</b>: E<sub>m</sub> {1} lx, E<sub>min</sub> {2} lx, E<sub>max</sub> {3} lx, "
           "U<sub>0</sub> {4}",
           "<b>{0}</b> : E<sub>m</sub> {1} lx, E<sub>min</sub> {2} lx, E<sub>max</sub> {3} lx, "
           "U<sub>0</sub> {4}",
           "<b>{0}</b>: E<sub>m</sub> {1} lx, E<sub>min</sub> {2} lx, E<sub>max</sub> {3} lx, "
           "U<sub>0</sub> {4}"}},
    Entry{Word::along_surface,
          {"along the surface", "entlang der Fläche", "le long de la surface",
           "a lo largo de la superficie"}},
    Entry{Word::on_paper, {"on A4 paper", "auf A4-Papier", "sur papier A4", "en papel A4"}},

    Entry{Word::glare, {"Glare", "Blendung", "Éblouissement", "Deslumbramiento"}},
    Entry{Word::glare_means,
          {"Unified glare rating by CIE 117, with new lamps{0}. L<sub>b</sub> is the background "
           "luminance; p the position index. Numbers are those in the plans.",
           "Blendungsbewertung UGR nach CIE 117, mit neuen Lampen{0}. L<sub>b</sub> ist die "
           "Hintergrundleuchtdichte, p der Positionsindex. Die Nummern sind die der Pläne.",
           "Taux d’éblouissement unifié (UGR) selon la CIE 117, avec des lampes neuves{0}. "
           "L<sub>b</sub> est la luminance de fond, p l’indice de position. Les numéros sont ceux "
           "des plans.",
           "Índice de deslumbramiento unificado (UGR) según CIE 117, con lámparas nuevas{0}. "
           "L<sub>b</sub> es la luminancia de fondo; p, el índice de posición. Los números son los "
           "de los planos."}},
    Entry{Word::glare_daylight_behind,
          {" and daylight in the background", " und Tageslicht im Hintergrund",
           " et la lumière naturelle en fond", " y luz natural en el fondo"}},
    Entry{Word::glare_without_daylight,
          {" and without daylight", " und ohne Tageslicht", " et sans lumière naturelle",
           " y sin luz natural"}},
    Entry{Word::observer, {"observer", "Beobachter", "observateur", "observador"}},
    Entry{Word::eye_at, {"eye at, {0}", "Auge bei, {0}", "œil à, {0}", "ojo en, {0}"}},
    Entry{Word::background,
          {"L<sub>b</sub>, cd/m²", "L<sub>b</sub>, cd/m²", "L<sub>b</sub>, cd/m²",
           "L<sub>b</sub>, cd/m²"}},
    Entry{Word::none_in_sight,
          {"none in sight", "keine in Sicht", "aucun en vue", "ninguna a la vista"}},
    Entry{Word::in_sight_of,
          {"Luminaires in sight of {0}", "Leuchten im Blickfeld von {0}",
           "Luminaires en vue de {0}", "Luminarias a la vista de {0}"}},
    Entry{Word::luminance,
          {"luminance, cd/m²", "Leuchtdichte, cd/m²", "luminance, cd/m²", "luminancia, cd/m²"}},
    Entry{Word::solid_angle,
          {"solid angle, sr", "Raumwinkel, sr", "angle solide, sr", "ángulo sólido, sr"}},
    Entry{Word::share, {"share", "Anteil", "part", "parte"}},
    Entry{Word::left_out,
          {"‘{0}’ is a point without luminous area, for which there is no UGR.",
           "„{0}“ ist ein Punkt ohne leuchtende Fläche, für den es keinen UGR gibt.",
           "« {0} » est un point sans surface lumineuse, pour lequel il n’y a pas d’UGR.",
           "«{0}» es un punto sin superficie luminosa, para el que no hay UGR."}},

    Entry{Word::assumptions,
          {"Assumptions and uncertainty", "Annahmen und Unsicherheit", "Hypothèses et incertitude",
           "Supuestos e incertidumbre"}},
    Entry{Word::maintenance_is,
          {"Maintenance factor: {0}", "Wartungsfaktor: {0}", "Facteur de maintenance : {0}",
           "Factor de mantenimiento: {0}"}},
    Entry{
        Word::sampling,
        {"The light of each point was gathered by {0} rays over the hemisphere, and by shadow rays "
         "to each lamp. The ± beside a value is a bound in lx with odds of about 19 to 1: the "
         "noise of this sampling, found from eight independent sets of rays, and the error of the "
         "reflected light that the rays read.",
         "Das Licht jedes Punktes wurde mit {0} Strahlen über den Halbraum und mit "
         "Schattenstrahlen zu jeder Lampe berechnet. Das ± neben einem Wert ist eine Schranke in "
         "lx mit einer Wahrscheinlichkeit von etwa 95 %: das Rauschen dieser Stichprobe, aus acht "
         "unabhängigen Sätzen von Strahlen, und der Fehler des reflektierten Lichts, auf das die "
         "Strahlen treffen.",
         "La lumière de chaque point est calculée par {0} rayons sur l’hémisphère et par des "
         "rayons d’ombre vers chaque lampe. Le ± à côté d’une valeur est une borne en lx avec une "
         "probabilité d’environ 95 % : le bruit de cet échantillonnage, déduit de huit "
         "ensembles indépendants de rayons, et l’erreur de la lumière réfléchie que lisent les "
         "rayons.",
         "La luz de cada punto se calculó con {0} rayos sobre el hemisferio y con rayos de sombra "
         "hacia cada lámpara. El ± junto a un valor es una cota en lx con una probabilidad de "
         "cerca del 95 %: el ruido de este muestreo, hallado con ocho conjuntos independientes de "
         "rayos, y "
         "el error de la luz reflejada que leen los rayos."}},
    Entry{
        Word::solution_error,
        {"Reflected light is read from a solution whose estimated error at a single point is {0} "
         "of the mean irradiance (root mean square); each gather averages over the errors of all "
         "points that its rays reach.",
         "Das reflektierte Licht stammt aus einer Lösung, deren geschätzter Fehler an einem "
         "einzelnen Punkt {0} der mittleren Bestrahlungsstärke ist (quadratisches Mittel); jeder "
         "Punkt mittelt über die Fehler aller Orte, die seine Strahlen erreichen.",
         "La lumière réfléchie est lue dans une solution dont l’erreur estimée en un point est de "
         "{0} de l’éclairement énergétique moyen (moyenne quadratique) ; chaque calcul fait la "
         "moyenne des erreurs de tous les points que ses rayons atteignent.",
         "La luz reflejada se lee de una solución cuyo error estimado en un punto es {0} de la "
         "irradiancia media (media cuadrática); cada cálculo promedia los errores de todos los "
         "puntos que alcanzan sus rayos."}},
    Entry{Word::buried_points,
          {"Points inside bodies or on their faces are left out.",
           "Punkte in Körpern oder auf ihren Flächen sind ausgelassen.",
           "Les points à l’intérieur des corps ou sur leurs faces sont omis.",
           "Se omiten los puntos dentro de los cuerpos o sobre sus caras."}},
    Entry{Word::spacing,
          {"Unless a spacing is given, points are as far apart as EN 12464-1 allows.",
           "Wenn kein Abstand angegeben ist, sind die Punkte so weit voneinander entfernt, wie EN "
           "12464-1 erlaubt.",
           "Sauf indication d’un espacement, les points sont aussi éloignés que l’EN 12464-1 le "
           "permet.",
           "Si no se indica una separación, los puntos distan entre sí lo que permite EN "
           "12464-1."}},
    Entry{
        Word::glare_of_new_lamps,
        {"Glare is that of new lamps, without the maintenance factor; sky and sun are no "
         "luminaires.",
         "Die Blendung ist die neuer Lampen, ohne Wartungsfaktor; Himmel und Sonne sind keine "
         "Leuchten.",
         "L’éblouissement est celui de lampes neuves, sans le facteur de maintenance ; le ciel et "
         "le soleil ne sont pas des luminaires.",
         "El deslumbramiento es el de lámparas nuevas, sin el factor de mantenimiento; el cielo y "
         "el sol no son luminarias."}},

    Entry{Word::basis,
          {"Basis of the calculation", "Grundlage der Berechnung", "Base du calcul",
           "Base del cálculo"}},
    Entry{Word::program, {"Program", "Programm", "Programme", "Programa"}},
    Entry{Word::scene_file,
          {"Scene file", "Szenendatei", "Fichier de la scène", "Archivo de la escena"}},
    Entry{Word::scene_hash,
          {"Hash of the scene", "Prüfwert der Szene", "Empreinte de la scène",
           "Huella de la escena"}},
    Entry{Word::options,
          {"Options of the solution", "Optionen der Lösung", "Options de la solution",
           "Opciones de la solución"}},
    Entry{Word::refinement,
          {"Fineness of the elements", "Feinheit der Elemente (Meldung des Programms)",
           "Finesse des éléments (message du programme)",
           "Finura de los elementos (mensaje del programa)"}},
    Entry{Word::seen_from,
          {"Estimated error seen from", "Geschätzter Fehler, gesehen von", "Erreur estimée, vue de",
           "Error estimado, visto desde"}},
    Entry{Word::error_estimate,
          {"Estimated error of the solution", "Geschätzter Fehler der Lösung",
           "Erreur estimée de la solution", "Error estimado de la solución"}},
    Entry{Word::error_unknown, {"not known", "nicht bekannt", "inconnue", "desconocido"}},
    Entry{Word::rays,
          {"Rays at each point", "Strahlen je Punkt", "Rayons par point", "Rayos por punto"}},

    Entry{Word::limits_of_standards,
          {"Limits of standards", "Grenzwerte der Normen", "Exigences des normes",
           "Límites de las normas"}},
    Entry{Word::limits_mean,
          {"A limit is met or missed if the figure keeps or breaks it by more than the ± of the "
           "figure; else it is too close to tell. Figures are of maintained electric light where "
           "it is known by itself.",
           "Ein Grenzwert ist eingehalten oder verfehlt, wenn der Wert um mehr als sein ± auf der "
           "einen oder anderen Seite liegt; sonst ist es zu knapp für ein Urteil. Die Werte sind "
           "Wartungswerte des Kunstlichts, wo es für sich bekannt ist.",
           "Une exigence est respectée ou manquée si la valeur se trouve d’un côté ou de l’autre "
           "de plus que son ± ; sinon, l’écart est trop faible pour conclure. Les valeurs sont "
           "celles à maintenir de la lumière électrique, quand elle est connue séparément.",
           "Un límite se cumple o no se cumple si el valor queda a un lado o al otro por más de su "
           "±; si no, está demasiado cerca para decidir. Los valores son los mantenidos de la luz "
           "eléctrica, cuando se conoce por separado."}},
    Entry{Word::figure, {"figure", "Größe", "grandeur", "magnitud"}},
    Entry{Word::value, {"value", "Wert", "valeur", "valor"}},
    Entry{Word::limit, {"limit", "Grenzwert", "exigence", "límite"}},
    Entry{Word::verdict, {"verdict", "Urteil", "conclusion", "veredicto"}},
    Entry{Word::met, {"met", "eingehalten", "respectée", "se cumple"}},
    Entry{Word::missed, {"missed", "verfehlt", "manquée", "no se cumple"}},
    Entry{Word::too_close,
          {"too close to tell", "zu knapp", "écart trop faible", "demasiado cerca"}},
    Entry{Word::recommended, {"recommended", "empfohlen", "recommandé", "recomendado"}},
    Entry{Word::light_at_the_eye,
          {"Light at the eye", "Licht am Auge", "Lumière à l’œil", "Luz en el ojo"}},
    Entry{
        Word::melanopic_edi,
        {"melanopic EDI, lx", "melanopische EDI, lx", "EDI mélanopique, lx", "EDI melanópica, lx"}},
    Entry{Word::energy_of_year,
          {"Energy of lighting in a year over {0} ({1} m²): LENI {2} kWh/m².",
           "Energie der Beleuchtung im Jahr über {0} ({1} m²): LENI {2} kWh/m².",
           "Énergie de l’éclairage en un an sur {0} ({1} m²) : LENI {2} kWh/m².",
           "Energía de la iluminación en un año sobre {0} ({1} m²): LENI {2} kWh/m²."}}};

constexpr bool entries_are_in_order() {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].word != static_cast<Word>(i)) return false;
  }
  return entries.size() == static_cast<std::size_t>(Word::count);
}
static_assert(entries_are_in_order());

}  // namespace

const char* word_in(Language language, Word word) {
  return entries[static_cast<std::size_t>(word)].texts[static_cast<std::size_t>(language)];
}

std::string worded(Language language, Word word, std::initializer_list<std::string> values) {
  std::string text;
  const std::string_view form = word_in(language, word);
  for (std::size_t i = 0; i < form.size(); ++i) {
    if (form[i] != '{') {
      text += form[i];
      continue;
    }
    const auto place = static_cast<std::size_t>(form[i + 1] - '0');
    if (place < values.size()) text += values.begin()[place];
    i += 2;
  }
  return text;
}

}  // namespace lightwell
