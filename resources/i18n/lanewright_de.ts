<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
    <context>
        <name>Lanewright</name>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>Road maps from mobile laser scanning, in QGIS.</source>
            <translation>Straßenkarten aus mobilem Laserscanning, in QGIS.</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>files</source>
            <translation>Dateien</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>file</source>
            <translation>Datei</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>vector layer</source>
            <translation>Vektorlayer</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>raster</source>
            <translation>Raster</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>CRS</source>
            <translation>KBS</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>number</source>
            <translation>Zahl</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>choice</source>
            <translation>Auswahl</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>yes or no</source>
            <translation>ja oder nein</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>text</source>
            <translation>Text</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>point cloud</source>
            <translation>Punktwolke</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>numbers</source>
            <translation>Zahlen</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>Numbers, for models and scripts:</source>
            <translation>Zahlen für Modelle und Skripte:</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>Lanewright manual</source>
            <translation>Lanewright-Handbuch</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>The algorithms, in the order of the work</source>
            <translation>Die Algorithmen, in der Reihenfolge der Arbeit</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>Results</source>
            <translation>Ergebnisse</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>On the command line</source>
            <translation>Auf der Kommandozeile</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>parameter</source>
            <translation>Parameter</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>what it is</source>
            <translation>was es ist</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>default</source>
            <translation>Vorgabe</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>One of: {choices}.</source>
            <translation>Eines von: {choices}.</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>Inputs</source>
            <translation>Eingaben</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>Advanced parameters</source>
            <translation>Erweiterte Parameter</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>optional</source>
            <translation>wahlfrei</translation>
        </message>
        <message>
            <location filename="../../tools/make_manual.py" />
            <source>Fields: {fields}.</source>
            <translation>Felder: {fields}.</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Survey</source>
            <translation>Vermessung</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Road</source>
            <translation>Straße</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Markings</source>
            <translation>Markierungen</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Driving</source>
            <translation>Fahren</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Road map</source>
            <translation>Straßenkarte</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Export</source>
            <translation>Export</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Inventory</source>
            <translation>Inventar</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Assessment</source>
            <translation>Bewertung</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Orthoimages</source>
            <translation>Orthobilder</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Where the vehicle drove: a point or line layer with heights, a table with columns time, x, y, z, or the path of a CSV, TXT or SBET file. Made with Import trajectory it needs no further care.</source>
            <translation>Wo das Fahrzeug fuhr: ein Punkt- oder Linienlayer mit Höhen, eine Tabelle mit den Spalten time, x, y, z oder der Pfad einer CSV-, TXT- oder SBET-Datei. Mit „Trajektorie einlesen“ erzeugt, braucht sie keine weitere Pflege.</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Warnings</source>
            <translation>Warnungen</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Point clouds</source>
            <translation>Punktwolken</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>LAS, LAZ or COPC files of one survey, or a folder that holds them, or names with wildcards (/data/B12/tile_*.laz). Files may overlap and come in any order. Withheld points and noise (classes 7 and 18) are left out.</source>
            <translation>LAS-, LAZ- oder COPC-Dateien einer Vermessung, ein Ordner, in dem sie liegen, oder Namen mit Platzhaltern (/data/B12/tile_*.laz). Dateien dürfen sich überlappen und in beliebiger Reihenfolge kommen. Zurückgehaltene Punkte (withheld) und Rauschen (Klassen 7 und 18) bleiben weg.</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Trajectory</source>
            <translation>Trajektorie</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>CRS of the point clouds</source>
            <translation>KBS der Punktwolken</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Only for point clouds that carry no CRS of their own, or contradict themselves; it is written into everything made from them.</source>
            <translation>Nur für Punktwolken, die kein eigenes KBS tragen oder sich widersprechen; es wird in alles geschrieben, was aus ihnen entsteht.</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>A page with the numbers of every step and a picture.</source>
            <translation>Eine Seite mit den Zahlen jedes Schrittes und einem Bild.</translation>
        </message>
        <message>
            <location filename="../../algorithms/algorithm.py" />
            <source>Report</source>
            <translation>Bericht</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Assess road boundaries</source>
            <translation>Straßenränder bewerten</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Sets road boundaries against reference lines, side by side in intervals of 2 m: precision, recall, errors across and in height.</source>
            <translation>Hält Straßenränder gegen Referenzlinien, je Seite in Abschnitten von 2 m: Genauigkeit, Vollständigkeit, Abweichungen quer und in der Höhe.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Any two line layers will do, of other software too: flat or with heights, in one part or many, drawn either way, with any fields. A layer in another CRS is reprojected. Where a layer tells tops from bottoms in a field part, bottoms count.</source>
            <translation>Zwei beliebige Linienlayer genügen, auch von anderer Software: mit oder ohne Höhen, ein- oder mehrteilig, in beliebiger Richtung gezeichnet, mit beliebigen Feldern. Ein Layer in einem anderen KBS wird umprojiziert. Wo ein Feld part Ober- und Unterkanten unterscheidet, zählen die Unterkanten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>accuracy</source>
            <translation>Genauigkeit</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>precision</source>
            <translation>Präzision</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>recall</source>
            <translation>Vollständigkeit</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>validation</source>
            <translation>Validierung</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>curb</source>
            <translation>Bordstein</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>reference</source>
            <translation>Referenz</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>ground truth</source>
            <translation>Bodenwahrheit</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Tolerance of the layer and of the numbers (m)</source>
            <translation>Toleranz des Layers und der Zahlen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>The tolerance for which intervals are drawn and numbers returned; the report has all of them.</source>
            <translation>Die Toleranz, für die Abschnitte gezeichnet und Zahlen zurückgegeben werden; der Bericht enthält alle.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Length of an interval (m)</source>
            <translation>Länge eines Abschnitts (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Longer lets a short error pass or spoil more of the road; published figures use 2.</source>
            <translation>Länger lässt einen kurzen Fehler durchgehen oder mehr von der Straße verderben; veröffentlichte Zahlen verwenden 2.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Corridor either side of the trajectory (m)</source>
            <translation>Korridor beiderseits der Trajektorie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>What lies farther out belongs to no road and is left out; the report tells how much.</source>
            <translation>Was weiter außen liegt, gehört zu keiner Straße und bleibt weg; der Bericht sagt, wie viel.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Precision (%)</source>
            <translation>Präzision (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Recall (%)</source>
            <translation>Vollständigkeit (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>F (%)</source>
            <translation>F (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Intersection over union (%)</source>
            <translation>Schnitt durch Vereinigung (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Correct intervals</source>
            <translation>Richtige Abschnitte</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Missed intervals</source>
            <translation>Fehlende Abschnitte</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>False intervals</source>
            <translation>Falsche Abschnitte</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Intervals that were not judged</source>
            <translation>Nicht beurteilte Abschnitte</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Mean lateral error (m)</source>
            <translation>Mittlere Querabweichung (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>RMSE across (m)</source>
            <translation>RMSE quer (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>95th percentile of the lateral error (m)</source>
            <translation>95. Perzentil der Querabweichung (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Largest lateral error (m)</source>
            <translation>Größte Querabweichung (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Mean height error (m)</source>
            <translation>Mittlere Höhenabweichung (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>RMSE in height (m)</source>
            <translation>RMSE in der Höhe (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>95th percentile of the height error (m)</source>
            <translation>95. Perzentil der Höhenabweichung (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Largest height error (m)</source>
            <translation>Größte Höhenabweichung (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Boundaries to assess</source>
            <translation>Zu bewertende Ränder</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Lines that were extracted, such as road edges.</source>
            <translation>Gefundene Linien, etwa Straßenränder.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Reference boundaries</source>
            <translation>Referenzränder</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Lines that are known to be right, one on each side of the road, such as the feet of the curbs.</source>
            <translation>Linien, von denen man weiß, dass sie stimmen, eine auf jeder Straßenseite, etwa die Bordsteinfüße.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Boundaries by outcome</source>
            <translation>Ränder nach Ergebnis</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>One line an interval and outcome.</source>
            <translation>Eine Linie je Abschnitt und Ergebnis.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Tolerances (m)</source>
            <translation>Toleranzen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Distances to either side within which a line is right, with commas between them. The report has a row for each.</source>
            <translation>Abstände zu jeder Seite, innerhalb derer eine Linie richtig ist, durch Kommas getrennt. Der Bericht hat für jeden eine Zeile.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Edges to judge</source>
            <translation>Zu beurteilende Ränder</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Road edges hold curbs and, where there is no curb, edges of the pavement. Curbs judges curbs alone; all judges whatever both layers hold. Automatic leaves edges of the pavement out where the field edge or kind of the reference says that it holds curbs alone: such a reference cannot tell whether they are right.</source>
            <translation>Straßenränder enthalten Bordsteine und, wo keiner ist, Ränder des Belags. Curbs beurteilt nur Bordsteine; all beurteilt alles, was beide Layer enthalten. Automatic lässt Ränder des Belags aus, wo das Feld edge oder kind der Referenz sagt, dass sie nur Bordsteine enthält: eine solche Referenz kann nicht sagen, ob sie richtig sind.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>lines</source>
            <translation>Linien</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>Intervals within {tolerance:g} cm: {correct:.0f} correct, {missed:.0f} missed, {false:.0f} false; {rates}.</source>
            <translation>Intervalle innerhalb {tolerance:g} cm: {correct:.0f} richtig, {missed:.0f} verfehlt, {false:.0f} falsch; {rates}.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_boundaries.py" />
            <source>{rate}, {side} (%)</source>
            <translation>{rate}, {side} (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Assess driving lines</source>
            <translation>Fahrlinien bewerten</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Sets driving lines against reference lines within buffers: completeness, correctness, miscoding, errors and gaps.</source>
            <translation>Hält Fahrlinien in Puffern gegen Referenzlinien: Vollständigkeit, Richtigkeit, Fehlkodierung, Abweichungen und Lücken.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Any two line layers will do, of other software too: flat or with heights, in one part or many, drawn either way, with any fields. A layer in another CRS is reprojected. Miscoding is the share of the result outside the buffer of the reference.</source>
            <translation>Zwei beliebige Linienlayer genügen, auch von anderer Software: mit oder ohne Höhen, ein- oder mehrteilig, in beliebiger Richtung gezeichnet, mit beliebigen Feldern. Ein Layer in einem anderen KBS wird umprojiziert. Fehlkodierung ist der Anteil des Ergebnisses außerhalb des Puffers der Referenz.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>miscoding</source>
            <translation>Fehlkodierung</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>completeness</source>
            <translation>Vollständigkeit</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>correctness</source>
            <translation>Richtigkeit</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>buffer</source>
            <translation>Puffer</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>The tolerance for which pieces are drawn and numbers returned, of the same kind as the others; the report has all of them.</source>
            <translation>Die Toleranz, für die Stücke gezeichnet und Zahlen zurückgegeben werden, von derselben Art wie die anderen; der Bericht enthält alle.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Largest angle between lines that match (°)</source>
            <translation>Größter Winkel zwischen zusammengehörigen Linien (°)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Smaller keeps lines that cross from matching; 90 lets any direction match. The way a line is drawn does not matter.</source>
            <translation>Kleiner verhindert, dass kreuzende Linien zusammenpassen; 90 lässt jede Richtung zu. Die Zeichenrichtung einer Linie spielt keine Rolle.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Completeness (%)</source>
            <translation>Vollständigkeit (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Correctness (%)</source>
            <translation>Richtigkeit (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Quality (%)</source>
            <translation>Qualität (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Miscoding (%)</source>
            <translation>Fehlkodierung (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Precision, the same as correctness (%)</source>
            <translation>Präzision, dasselbe wie Richtigkeit (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Recall, the same as completeness (%)</source>
            <translation>Vollständigkeit der Referenz (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>F1 (%)</source>
            <translation>F1 (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Gaps per km</source>
            <translation>Lücken je km</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Mean length of the gaps (m)</source>
            <translation>Mittlere Länge der Lücken (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Length of the result (m)</source>
            <translation>Länge des Ergebnisses (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Length of the reference (m)</source>
            <translation>Länge der Referenz (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Driving lines to assess</source>
            <translation>Zu bewertende Fahrlinien</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Lines that were made.</source>
            <translation>Erzeugte Linien.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Reference lines</source>
            <translation>Referenzlinien</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Lines that are known to be right, such as those drawn over an orthoimage.</source>
            <translation>Linien, von denen man weiß, dass sie stimmen, etwa über einem Orthobild gezeichnete.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Driving lines by outcome</source>
            <translation>Fahrlinien nach Ergebnis</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>The lines cut where the outcome changes: false pieces lie outside the buffer.</source>
            <translation>Die Linien, geschnitten, wo das Ergebnis wechselt: falsche Stücke liegen außerhalb des Puffers.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Sizes of the buffer, with commas between them. The report has a row for each.</source>
            <translation>Größen des Puffers, durch Kommas getrennt. Der Bericht hat für jede eine Zeile.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Tolerances are</source>
            <translation>Toleranzen sind</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Half-width: from the line to the rim of its buffer. Total-width: from rim to rim, so that 0.20 lets a line be 0.10 m off. Published figures seldom say which they mean; the report shows both.</source>
            <translation>Half-width: von der Linie zum Rand ihres Puffers. Total-width: von Rand zu Rand, sodass 0.20 einer Linie 0,10 m Abweichung lässt. Veröffentlichte Zahlen sagen selten, was sie meinen; der Bericht zeigt beides.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_driving_lines.py" />
            <source>Within {tolerance:g} cm to either side: {rates}.</source>
            <translation>Innerhalb von {tolerance:g} cm zu jeder Seite: {rates}.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Assess markings</source>
            <translation>Markierungen bewerten</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Sets road markings against a reference, cell by cell, by class and by object: precision, recall, F1 and intersection over union.</source>
            <translation>Hält Straßenmarkierungen gegen eine Referenz, Zelle für Zelle, nach Klasse und nach Objekt: Präzision, Vollständigkeit, F1 und Schnitt durch Vereinigung.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Polygons, lines or a raster mask (anything but 0 and no-data is paint), of other software too, on either side. A layer in another CRS is reprojected.</source>
            <translation>Polygone, Linien oder eine Rastermaske (alles außer 0 und NoData ist Farbe), auch von anderer Software, auf beiden Seiten. Ein Layer in einem anderen KBS wird umprojiziert.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>iou</source>
            <translation>iou</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>road marking</source>
            <translation>Straßenmarkierung</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Tolerance of objects and of the layer (cells)</source>
            <translation>Toleranz der Objekte und des Layers (Zellen)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Objects are judged and numbers ending in TOLERANT returned with this tolerance; the report has all of them.</source>
            <translation>Objekte werden mit dieser Toleranz beurteilt und Zahlen auf TOLERANT mit ihr zurückgegeben; der Bericht enthält alle.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Cell size (m)</source>
            <translation>Zellgröße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Smaller weighs the rims of markings more and takes longer; published figures use 0.04.</source>
            <translation>Kleiner gewichtet die Ränder der Markierungen stärker und dauert länger; veröffentlichte Zahlen verwenden 0.04.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Width of lines (m)</source>
            <translation>Breite der Linien (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>How wide paint is where a layer of lines has no field width_m or width.</source>
            <translation>Wie breit Farbe ist, wo ein Linienlayer kein Feld width_m oder width hat.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Share of an object that makes it found (0-1)</source>
            <translation>Anteil eines Objekts, der es gefunden macht (0-1)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Higher asks for more of an object before it counts as found, or as right.</source>
            <translation>Höher verlangt mehr von einem Objekt, bevor es als gefunden oder als richtig zählt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Cells that are right</source>
            <translation>Richtige Zellen</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Cells that were missed</source>
            <translation>Fehlende Zellen</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Cells that are false</source>
            <translation>Falsche Zellen</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Image that shows what was scanned</source>
            <translation>Bild, das zeigt, was gescannt wurde</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Where this raster, such as the intensity image, is empty nothing is judged, and the report's map lies over it. It hides what was never scanned, but also what the road surface left out: leave it empty to hold that against the result.</source>
            <translation>Wo dieses Raster, etwa das Intensitätsbild, leer ist, wird nichts beurteilt, und die Karte des Berichts liegt darüber. Es verdeckt, was nie gescannt wurde, aber auch, was die Straßenoberfläche ausgelassen hat: leer lassen, um das dem Ergebnis anzulasten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Markings by outcome</source>
            <translation>Markierungen nach Ergebnis</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Objects of the reference, correct or missed, and the false ones of the result.</source>
            <translation>Objekte der Referenz, richtig oder fehlend, und die falschen des Ergebnisses.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Hits, misses and false alarms</source>
            <translation>Treffer, Fehlstellen und Fehlalarme</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>1 hit, 2 missed, 3 false, 4 missed beside a hit (within the tolerance), 5 false beside paint.</source>
            <translation>1 Treffer, 2 fehlend, 3 falsch, 4 fehlend neben einem Treffer (innerhalb der Toleranz), 5 falsch neben Farbe.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Markings to assess</source>
            <translation>Zu bewertende Markierungen</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Polygons, lines with a width, or a mask.</source>
            <translation>Polygone, Linien mit Breite oder eine Maske.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Reference markings</source>
            <translation>Referenzmarkierungen</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Polygons, lines or a raster of what is painted; the values of a raster are its classes.</source>
            <translation>Polygone, Linien oder ein Raster dessen, was aufgemalt ist; die Werte eines Rasters sind seine Klassen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Tolerances (cells)</source>
            <translation>Toleranzen (Zellen)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Cells by which the other layer is widened before it is asked, with commas between them; 0 is strict.</source>
            <translation>Zellen, um die der andere Layer verbreitert wird, bevor er befragt wird, durch Kommas getrennt; 0 ist streng.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Field with the class</source>
            <translation>Feld mit der Klasse</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Looked for in both layers; a layer without it has no classes. Fields named mark_class and kind are found too.</source>
            <translation>Wird in beiden Layern gesucht; ein Layer ohne es hat keine Klassen. Felder namens mark_class und kind werden auch gefunden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>Cells, strict: {strict}; with a tolerance of {cells}: {tolerant}.</source>
            <translation>Zellen, streng: {strict}; mit einer Toleranz von {cells}: {tolerant}.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/assess_markings.py" />
            <source>{what} (%)</source>
            <translation>{what} (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/inputs.py" />
            <source>Area</source>
            <translation>Gebiet</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/inputs.py" />
            <source>Polygons. What lies outside is left out of both layers; without it a result beyond the ends of the reference is false.</source>
            <translation>Polygone. Was außerhalb liegt, bleibt in beiden Layern weg; ohne sie ist ein Ergebnis jenseits der Enden der Referenz falsch.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/inputs.py" />
            <source>Rows of the reference that are not judged</source>
            <translation>Zeilen der Referenz, die nicht beurteilt werden</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/inputs.py" />
            <source>An expression, such as "type" = 'driveway': where it holds, a result is neither right nor wrong. Empty leaves out the rows whose field edge or kind says dropped or none.</source>
            <translation>Ein Ausdruck wie "type" = 'driveway': wo er gilt, ist ein Ergebnis weder richtig noch falsch. Leer lässt die Zeilen weg, deren Feld edge oder kind dropped oder none sagt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/inputs.py" />
            <source>{label} has no polygons. Leave it empty to judge everywhere.</source>
            <translation>{label} hat keine Polygone. Leer lassen, um überall zu urteilen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/assess/inputs.py" />
            <source>{label} is {text!r}; give numbers with commas between them, such as 0.05, 0.10, 0.20.</source>
            <translation>{label} ist {text!r}; bitte Zahlen mit Kommas dazwischen angeben, etwa 0.05, 0.10, 0.20.</translation>
        </message>
        <message>
            <location filename="../../algorithms/call.py" />
            <source>Free some space there; the variable TMPDIR (Windows: TEMP) names the folder for temporary files.</source>
            <translation>Dort Platz schaffen; die Variable TMPDIR (Windows: TEMP) nennt den Ordner für vorübergehende Dateien.</translation>
        </message>
        <message>
            <location filename="../../algorithms/call.py" />
            <source>{label} names {path}, which is not a file. Choose the LAS or LAZ file itself.</source>
            <translation>{label} nennt {path}, das ist keine Datei. Die LAS- oder LAZ-Datei selbst wählen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/call.py" />
            <source>{label}: there is no file {path}. Check the name and the folder.</source>
            <translation>{label}: die Datei {path} gibt es nicht. Name und Ordner prüfen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/call.py" />
            <source>Columns are those of a text file; {label} is a layer, whose fields have names. Leave Columns empty, or choose the file.</source>
            <translation>Spalten gibt es in einer Textdatei; {label} ist ein Layer, dessen Felder Namen haben. Spalten leer lassen oder die Datei wählen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/call.py" />
            <source>while writing</source>
            <translation>beim Schreiben</translation>
        </message>
        <message>
            <location filename="../../algorithms/call.py" />
            <source>{label} would be written over {path}, which is read as {input}: inputs are never changed. Give it another name.</source>
            <translation>„{label}“ würde {path} überschreiben, das als „{input}“ gelesen wird: Eingaben werden nie verändert. Bitte einen anderen Namen wählen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/call.py" />
            <source>{first} and {second} would both be written to {path}, and one would be lost. Give each a file of its own, or name the layers in one GeoPackage: ogr:dbname='map.gpkg' table="road_edges" (geom).</source>
            <translation>{first} und {second} würden beide nach {path} geschrieben, und eines ginge verloren. Jedem eine eigene Datei geben oder die Layer in einem GeoPackage benennen: ogr:dbname='map.gpkg' table="road_edges" (geom).</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>automatic</source>
            <translation>automatisch</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>gps</source>
            <translation>GPS (seit 1980)</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>adjusted</source>
            <translation>GPS weniger eine Milliarde</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>week</source>
            <translation>Woche</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>day</source>
            <translation>Tag</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>street</source>
            <translation>Straße</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>rural</source>
            <translation>Landstraße</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>urban</source>
            <translation>Stadt</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>one-lane</source>
            <translation>ein Fahrstreifen</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>wide-lane</source>
            <translation>breiter Fahrstreifen</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>no-centre-line</source>
            <translation>ohne Mittellinie</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>hatched-island</source>
            <translation>Sperrflächeninsel</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>motorway</source>
            <translation>Autobahn</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>serpentine</source>
            <translation>Serpentine</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>crossing</source>
            <translation>Kreuzung</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>roundabout</source>
            <translation>Kreisverkehr</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>outskirts</source>
            <translation>Ortsrand</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>cycle-lanes</source>
            <translation>Radfahrstreifen</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>intensity</source>
            <translation>Intensität</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>rgb</source>
            <translation>Helligkeit der Farben</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>profiles</source>
            <translation>Profile</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>scanlines</source>
            <translation>Scanlinien</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>both</source>
            <translation>beide</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>linear</source>
            <translation>linear</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>logarithmic</source>
            <translation>logarithmisch</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>multi-threshold</source>
            <translation>mehrere Schwellen</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>intensity-peaks</source>
            <translation>Intensitätsspitzen</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>point-segments</source>
            <translation>Punktsegmente</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>all</source>
            <translation>alle</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>windows</source>
            <translation>Fenster</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>neutral</source>
            <translation>neutral</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>china</source>
            <translation>China</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>germany</source>
            <translation>Deutschland</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>japan</source>
            <translation>Japan</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>united-states</source>
            <translation>Vereinigte Staaten</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>line</source>
            <translation>Gerade</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>circle</source>
            <translation>Kreis</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>ellipse</source>
            <translation>Ellipse</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>clothoid</source>
            <translation>Klothoide</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>polynomial</source>
            <translation>Polynom</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>b-spline</source>
            <translation>B-Spline</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>right</source>
            <translation>rechts</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>left</source>
            <translation>links</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>nonurban</source>
            <translation>außerorts</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>half-width</source>
            <translation>halbe Breite</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>total-width</source>
            <translation>ganze Breite</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>draw</source>
            <translation>zeichnen</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>leave-out</source>
            <translation>weglassen</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>bilinear</source>
            <translation>bilinear</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>nearest</source>
            <translation>nächster</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>cubic</source>
            <translation>kubisch</translation>
        </message>
        <message>
            <location filename="../../algorithms/choice_words.py" />
            <source>curbs</source>
            <translation>Bordsteine</translation>
        </message>
        <message>
            <location filename="../../algorithms/cloud_files.py" />
            <source>{label}: the folder {name} holds no LAS or LAZ file.</source>
            <translation>{label}: Im Ordner {name} liegt keine LAS- oder LAZ-Datei.</translation>
        </message>
        <message>
            <location filename="../../algorithms/cloud_files.py" />
            <source>{label}: no LAS or LAZ file is called {name}.</source>
            <translation>{label}: Keine LAS- oder LAZ-Datei heißt {name}.</translation>
        </message>
        <message>
            <location filename="../../algorithms/corrections.py" />
            <source>Corrections</source>
            <translation>Korrekturen</translation>
        </message>
        <message>
            <location filename="../../algorithms/corrections.py" />
            <source>What an analyst decided at doubtful places: points or lines with the fields action (accept, delete, move, draw, take) and target (edge, marking, lane). Further fields: note; kind and pattern of a line that is drawn; other of a second reading that is taken. A row concerns what this run finds within half a metre of it, whatever its number; for lanes it is one metre, for move two. A row without geometry lies at its road, station_m and offset_m. What matches nothing is listed in log and report. The window of doubtful places writes this layer.</source>
            <translation>Was an zweifelhaften Stellen entschieden wurde: Punkte oder Linien mit den Feldern action (accept, delete, move, draw, take) und target (edge, marking, lane). Weitere Felder: note; kind und pattern einer gezeichneten Linie; other einer zweiten Lesart, die genommen wird. Eine Zeile gilt dem, was dieser Lauf im Umkreis von einem halben Meter findet, gleich welche Nummer es hat; bei Fahrstreifen ist es ein Meter, bei move sind es zwei. Eine Zeile ohne Geometrie liegt bei ihrem road, station_m und offset_m. Was zu nichts passt, steht in Protokoll und Bericht. Das Fenster der zweifelhaften Stellen schreibt diesen Layer.</translation>
        </message>
        <message>
            <location filename="../../algorithms/corrections.py" />
            <source>{label} lacks the field(s) {fields}. Make the layer with the buttons of the window of doubtful places, or give it the fields action and target.</source>
            <translation>{label} fehlen die Felder {fields}. Den Layer mit den Knöpfen im Fenster der zweifelhaften Stellen anlegen oder ihm die Felder action und target geben.</translation>
        </message>
        <message>
            <location filename="../../algorithms/destinations.py" />
            <source>{label} was to be written to {path}, but it is written as {kinds} only. Name the file so.</source>
            <translation>{label} sollte nach {path} geschrieben werden, wird aber nur als {kinds} geschrieben. Die Datei so benennen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/destinations.py" />
            <source>{label} was to be written to {path}, but a DXF has no fields. Write a GeoPackage and bring it to DXF with the QGIS algorithm “Export layers to DXF”.</source>
            <translation>{label} sollte nach {path} geschrieben werden, aber ein DXF hat keine Felder. Ein GeoPackage schreiben und mit dem QGIS-Algorithmus „Layer nach DXF exportieren“ nach DXF bringen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/destinations.py" />
            <source>{label} was to be written to {path}, whose ending names no format that QGIS writes. Use .gpkg, .fgb or .shp.</source>
            <translation>{label} sollte nach {path} geschrieben werden, dessen Endung kein Format nennt, das QGIS schreibt. .gpkg, .fgb oder .shp verwenden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/destinations.py" />
            <source>{label} was to be written to {path}, but there is no folder {folder}. Create it or choose another.</source>
            <translation>{label} sollte nach {path} geschrieben werden, aber den Ordner {folder} gibt es nicht. Ihn anlegen oder einen anderen wählen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/destinations.py" />
            <source>{label} was to be written to {path}, which is a folder. Name a file in it.</source>
            <translation>{label} sollte nach {path} geschrieben werden, das ist ein Ordner. Eine Datei darin benennen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/destinations.py" />
            <source>{label} cannot be written to {path}: {reason}. Choose another place, or close the program that holds it.</source>
            <translation>{label} kann nicht nach {path} geschrieben werden: {reason}. Einen anderen Ort wählen oder das Programm schließen, das die Datei hält.</translation>
        </message>
        <message>
            <location filename="../../algorithms/destinations.py" />
            <source>{path} cannot be written: {reason}. Close the program that holds it, or choose another file.</source>
            <translation>{path} lässt sich nicht schreiben: {reason}. Das Programm schließen, das die Datei offen hält, oder eine andere Datei wählen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/destinations.py" />
            <source> or </source>
            <translation> oder </translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Driving lines</source>
            <translation>Fahrlinien</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Draws the line to drive in every lane, in the direction of travel, and tabulates the elements of its curves.</source>
            <translation>Zeichnet in jedem Fahrstreifen die Linie, auf der man fährt, in Fahrtrichtung, und stellt die Elemente ihrer Bögen zusammen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>lane</source>
            <translation>Fahrstreifen</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>centre line</source>
            <translation>Mittellinie</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>hd map</source>
            <translation>HD-Karte</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>curve elements</source>
            <translation>Bogenelemente</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>radius</source>
            <translation>Radius</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Country</source>
            <translation>Land</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Whose dashes are looked for, whose usual lane is assumed where the data do not decide, and whose design code curves are checked against. It is never guessed; neutral holds for roads of all countries of the catalogue and checks curves against CJJ 37-2012.</source>
            <translation>Dessen Strichlängen gesucht werden, dessen übliche Fahrstreifenbreite gilt, wo die Daten nicht entscheiden, und an dessen Entwurfsrichtlinie Kurven geprüft werden. Es wird nie geraten; neutral gilt für Straßen aller Länder des Katalogs und prüft Kurven nach CJJ 37-2012.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Lane width, 0 = as seen on the road (m)</source>
            <translation>Breite der Fahrstreifen, 0 = wie auf der Straße gesehen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>0 takes the width that is seen between lines. A width named here is held to: where only the outer lines are painted, their distance and this width give the number of lanes. Wider makes fewer lanes.</source>
            <translation>0 nimmt die Breite, die zwischen Linien zu sehen ist. Eine hier genannte Breite gilt: Wo nur die äußeren Linien markiert sind, folgt die Zahl der Fahrstreifen aus deren Abstand und dieser Breite. Breiter ergibt weniger Fahrstreifen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Distance from a line without partner, 0 = half a lane (m)</source>
            <translation>Abstand von einer Linie ohne Gegenstück, 0 = halber Fahrstreifen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>How far beside a painted line the driving line runs where the lane has no second line.</source>
            <translation>Wie weit neben einer aufgemalten Linie die Fahrlinie verläuft, wo der Fahrstreifen keine zweite Linie hat.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Side of traffic</source>
            <translation>Verkehrsseite</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>The side one drives on; it gives the driving lines their direction. Automatic goes by where and which way the vehicle drove, and by lines that part the directions. A side named here counts more than the drive.</source>
            <translation>Die Seite, auf der man fährt; sie gibt den Fahrlinien ihre Richtung. Automatisch richtet sich danach, wo und wohin das Fahrzeug fuhr, und nach Linien, die die Richtungen trennen. Eine hier genannte Seite zählt mehr als die Fahrt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Longest gap of all lines bridged (m)</source>
            <translation>Längste überbrückte Lücke aller Linien (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Longer leads lanes through wider crossings; shorter leaves them open.</source>
            <translation>Länger führt Fahrstreifen über breitere Kreuzungen; kürzer lässt sie offen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Longest gap beside other lines closed (m)</source>
            <translation>Längste neben anderen Linien geschlossene Lücke (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Where another line of the road goes on, a lane is led along it through a gap up to this length.</source>
            <translation>Wo eine andere Linie der Straße weitergeht, wird ein Fahrstreifen an ihr entlang durch eine Lücke bis zu dieser Länge geführt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Shortest driving line (m)</source>
            <translation>Kürzeste Fahrlinie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Shorter keeps stubs at the ends of the survey.</source>
            <translation>Kürzer behält Stummel an den Enden der Vermessung.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Marking lines</source>
            <translation>Markierungslinien</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>The layer written by Fit marking lines.</source>
            <translation>Der von „Markierungslinien einpassen“ geschriebene Layer.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>With it a lane continues through zebra crossings and past stop lines, and kinds of gaps are distinguished.</source>
            <translation>Damit wird ein Fahrstreifen über Zebrastreifen und Haltlinien geführt, und Lücken werden unterschieden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Road edges</source>
            <translation>Straßenränder</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>With it lanes without an outer line end at the edge.</source>
            <translation>Damit enden Fahrstreifen ohne äußere Linie am Rand.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Road points</source>
            <translation>Straßenpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>With it heights are the road's own.</source>
            <translation>Damit sind die Höhen die der Straße selbst.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Lanes</source>
            <translation>Fahrstreifen</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>Curve elements</source>
            <translation>Bogenelemente</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/driving_lines.py" />
            <source>The area of each lane between its borders, with what follows it. Exports to HD maps are made from this layer.</source>
            <translation>Die Fläche jedes Fahrstreifens zwischen seinen Rändern, und was auf ihn folgt. Aus diesem Layer werden HD-Karten ausgegeben.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>From a survey to driving lines in one call: edges, surface, intensity image, markings, lines and curve elements.</source>
            <translation>Von einer Vermessung zu Fahrlinien in einem Aufruf: Ränder, Oberfläche, Intensitätsbild, Markierungen, Linien und Bogenelemente.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>Point clouds, the trajectory, and where to save are enough: everything else has a default that suits most surveys. The stages are those of the single algorithms, handed on in memory. Every output is optional.</source>
            <translation>Punktwolken, die Trajektorie und der Ort zum Speichern genügen: Alles andere ist so voreingestellt, dass es für die meisten Vermessungen passt. Die Stufen sind die der einzelnen Algorithmen, im Speicher weitergereicht. Jede Ausgabe ist wahlfrei.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>driving line</source>
            <translation>Fahrlinie</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>kerb</source>
            <translation>Bordkante</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>Road surface</source>
            <translation>Straßenoberfläche</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>Passes (the trajectory)</source>
            <translation>Fahrten (die Trajektorie)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>Where the vehicle drove, as this run used it: one line a pass.</source>
            <translation>Wo das Fahrzeug fuhr, wie dieser Lauf es verwendet hat: eine Linie je Fahrt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>Curb points</source>
            <translation>Bordsteinpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>Class 11, with the fields the single stages need.</source>
            <translation>Klasse 11, mit den Feldern, die die einzelnen Stufen brauchen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>Intensity image</source>
            <translation>Intensitätsbild</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>Correct intensity first</source>
            <translation>Zuerst Intensität korrigieren</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>Evens out range, incidence and the difference between scanners. Switch it off for clouds whose intensity was corrected already.</source>
            <translation>Gleicht Entfernung, Einfallswinkel und den Unterschied der Scanner aus. Ausschalten bei Wolken, deren Intensität schon korrigiert wurde.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map.py" />
            <source>No result was asked for, and all of the work would be lost. Name at least one output, such as DRIVING_LINES, MARKINGS or REPORT.</source>
            <translation>Es wurde kein Ergebnis verlangt, und die ganze Arbeit wäre verloren. Nennen Sie mindestens eine Ausgabe, etwa DRIVING_LINES, MARKINGS oder REPORT.</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Roads</source>
            <translation>Straßen</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Length of the roads (m)</source>
            <translation>Länge der Straßen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Length of the road edges (m)</source>
            <translation>Länge der Fahrbahnränder (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Of the road edges measured (%)</source>
            <translation>Davon gemessen: Fahrbahnränder (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Length of the marking lines (m)</source>
            <translation>Länge der Markierungslinien (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Of the marking lines measured (%)</source>
            <translation>Davon gemessen: Markierungslinien (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Length of the driving lines (m)</source>
            <translation>Länge der Fahrlinien (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Of the driving lines measured (%)</source>
            <translation>Davon gemessen: Fahrlinien (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Confidence of the driving lines, mean along them (0 to 1)</source>
            <translation>Zuverlässigkeit der Fahrlinien, Mittel über ihre Länge (0 bis 1)</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Corrections made</source>
            <translation>Ausgeführte Korrekturen</translation>
        </message>
        <message>
            <location filename="../../algorithms/driving/road_map_numbers.py" />
            <source>Corrections that match nothing</source>
            <translation>Korrekturen, zu denen nichts passt</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>Check HD map</source>
            <translation>HD-Karte prüfen</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>Looks for faults of an OpenDRIVE or Lanelet2 map that other validators pass over, and puts them on the map.</source>
            <translation>Sucht Fehler einer OpenDRIVE- oder Lanelet2-Karte, die andere Prüfprogramme übergehen, und legt sie auf die Karte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>OpenDRIVE: gaps, kinks and steps between geometries, profiles and linked lanes, wrong lengths, lanes narrower than nothing, borders that fold back in curves, numbering, types, links that lead nowhere or one way only, lanes that end though the road goes on, roads on one another, words, numbers and orders of records that the standard does not have, a geoReference that is none.</source>
            <translation>OpenDRIVE: Lücken, Knicke und Stufen zwischen Geometrien, Höhenverläufen und verknüpften Fahrstreifen, falsche Längen, Fahrstreifen schmaler als nichts, Ränder, die in Kurven umschlagen, Nummern, Typen, Verknüpfungen, die nirgendwohin oder nur in eine Richtung führen, Fahrstreifen, die enden, obwohl die Straße weitergeht, Straßen aufeinander, Wörter, Zahlen und Reihenfolgen, die der Standard nicht kennt, eine geoReference, die keine ist.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>Lanelet2: missing nodes and members, types and tags that no reader knows, borders that cross, swap sides or lie there twice, lanelets that meet without sharing their nodes or meet head on, nodes that lie aside, rules of traffic that are not whole or that nobody obeys.</source>
            <translation>Lanelet2: fehlende Knoten und Mitglieder, Typen und Tags, die kein Leser kennt, Ränder, die sich kreuzen, vertauscht oder doppelt sind, Lanelets, die sich treffen, ohne ihre Knoten zu teilen, oder gegeneinander führen, Knoten, die abseits liegen, Verkehrsregeln, die nicht vollständig sind oder die niemand befolgt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>The same finding at many places is one row of the report and one line of the log, with its count, its places and the largest; those at the fewest places come first. A schema validator looks at other things; use both.</source>
            <translation>Derselbe Befund an vielen Stellen ist eine Zeile im Bericht und eine im Protokoll, mit Anzahl, Stellen und dem größten; Befunde an den wenigsten Stellen kommen zuerst. Eine Schemaprüfung sieht auf anderes; nehmen Sie beides.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>OpenDRIVE</source>
            <translation>OpenDRIVE</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>Lanelet2</source>
            <translation>Lanelet2</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>HD map</source>
            <translation>HD-Karte</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>topology</source>
            <translation>Topologie</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>routing</source>
            <translation>Routing</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>Findings</source>
            <translation>Befunde</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>Kinds of faults</source>
            <translation>Arten von Fehlern</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>Driven lanes and pieces</source>
            <translation>Befahrene Fahrstreifen und Stücke</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>Links from one lane to the next</source>
            <translation>Verknüpfungen von einem Fahrstreifen zum nächsten</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>Pairs of lanes side by side</source>
            <translation>Paare von Fahrstreifen nebeneinander</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>Map file</source>
            <translation>Kartendatei</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>An OpenDRIVE (.xodr) or Lanelet2 (.osm) map; what is in it decides.</source>
            <translation>Eine Karte in OpenDRIVE (.xodr) oder Lanelet2 (.osm); der Inhalt entscheidet.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>A point for each finding, with the row of the report in which the same findings are one. Heights are the map's.</source>
            <translation>Ein Punkt je Befund, mit der Zeile des Berichts, die gleiche Befunde zusammenfasst. Höhen sind die der Karte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>CRS of the findings</source>
            <translation>KBS der Befunde</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>OpenDRIVE: only where the file does not say it. Lanelet2: projected, such as that of the survey; empty takes the UTM zone of the map.</source>
            <translation>OpenDRIVE: nur wo die Datei es nicht sagt. Lanelet2: projiziert, etwa das der Vermessung; leer nimmt die UTM-Zone der Karte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>{findings} findings; {lanes} driven lanes and pieces, {successors} links to the next, {neighbours} pairs side by side.</source>
            <translation>{findings} Befunde; {lanes} befahrene Fahrstreifen und Stücke, {successors} Verknüpfungen zum nächsten, {neighbours} Paare nebeneinander.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>{path} begins neither as OpenDRIVE nor as Lanelet2 does. Choose a file with the ending .xodr or .osm.</source>
            <translation>{path} beginnt weder wie OpenDRIVE noch wie Lanelet2. Wählen Sie eine Datei mit der Endung .xodr oder .osm.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>{fault}: {count} ({places}). {text}</source>
            <translation>{fault}: {count} ({places}). {text}</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/check_map.py" />
            <source>The first {shown} of {count}; the layer has all of them.</source>
            <translation>Die ersten {shown} von {count}; der Layer hat alle.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Export CAD</source>
            <translation>CAD exportieren</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Writes the road map for the design office: 3D polylines as DXF, or alignments of lines, curves and spirals with profile as LandXML.</source>
            <translation>Schreibt die Straßenkarte fürs Planungsbüro: 3D-Polylinien als DXF oder Achsen aus Geraden, Bögen und Klothoiden mit Gradiente als LandXML.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>DXF: lane borders, driving lines, marking lines, road edges and outlines of markings as 3D polylines, each class in a layer of its own with a colour. LandXML 1.2: the axis of every road and every driving line as an alignment of the fitted lines, curves and spirals, with a profile of tangents; a line that no elements follow within the tolerance is an irregular line.</source>
            <translation>DXF: Ränder der Fahrstreifen, Fahrlinien, Markierungslinien, Fahrbahnränder und Umrisse der Markierungen als 3D-Polylinien, jede Klasse in einem eigenen Layer mit einer Farbe. LandXML 1.2: die Achse jeder Straße und jede Fahrlinie als Achse aus den angepassten Geraden, Bögen und Klothoiden, mit einer Gradiente aus Tangenten; eine Linie, der keine Elemente innerhalb der Toleranz folgen, ist eine unregelmäßige Linie.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>DXF has no place for the CRS; LandXML names it. Both have the units of the layers' CRS, such as US survey feet. Cross-sections, surfaces and texts are not there.</source>
            <translation>DXF hat keinen Platz für das KBS; LandXML nennt es. Beide haben die Einheiten des KBS der Layer, etwa US-Survey-Fuß. Querprofile, Flächen und Texte sind nicht darin.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>DXF</source>
            <translation>DXF</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>LandXML</source>
            <translation>LandXML</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>CAD</source>
            <translation>CAD</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>alignment</source>
            <translation>Achse</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>profile</source>
            <translation>Profil</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Tolerance (m)</source>
            <translation>Toleranz (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>LandXML: how far a line may be missed by its elements, in plan and in height. DXF has every vertex.</source>
            <translation>LandXML: wie weit eine Linie von ihren Elementen verfehlt werden darf, in Lage und Höhe. DXF hat jeden Stützpunkt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Lines</source>
            <translation>Linien</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Alignments</source>
            <translation>Achsen</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Largest distance of a line from its elements (m)</source>
            <translation>Größter Abstand einer Linie von ihren Elementen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>CAD file</source>
            <translation>CAD-Datei</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>With the ending .dxf, or .xml for LandXML.</source>
            <translation>Mit der Endung .dxf oder, für LandXML, .xml.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Format</source>
            <translation>Format</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>dxf is drawn by every CAD program, landxml is taken over by programs for road design.</source>
            <translation>dxf zeichnet jedes CAD-Programm, landxml übernehmen Programme für den Straßenentwurf.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>{count} polylines in {layers} layers.</source>
            <translation>{count} Polylinien in {layers} Layern.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Layers</source>
            <translation>Layer</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>{count} alignments, {length:.0f} m; elements within {missed:.3f} m of their lines.</source>
            <translation>{count} Achsen, {length:.0f} m; Elemente innerhalb {missed:.3f} m von ihren Linien.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Name</source>
            <translation>Name</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>What it is</source>
            <translation>Was es ist</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Length (m)</source>
            <translation>Länge (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Elements</source>
            <translation>Elemente</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Points of the profile</source>
            <translation>Punkte des Höhenplans</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Road map for CAD</source>
            <translation>Straßenkarte für CAD</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Layer</source>
            <translation>Layer</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>Polylines</source>
            <translation>Polylinien</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>{count} lines are followed by no elements within the tolerance and are irregular lines.</source>
            <translation>{count} Linien folgen keine Elemente innerhalb der Toleranz; sie sind unregelmäßige Linien.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_cad.py" />
            <source>{path} has the ending of {named}, but FORMAT is {kind}. Change one of them.</source>
            <translation>{path} hat die Endung von {named}, aber FORMAT ist {kind}. Ändern Sie eines davon.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Export Lanelet2</source>
            <translation>Lanelet2 exportieren</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Writes lanes as a Lanelet2 map for planners such as Autoware: lanelets that share their borders, with heights and centre lines.</source>
            <translation>Schreibt Fahrstreifen als Lanelet2-Karte für Planer wie Autoware: Lanelets, die ihre Ränder teilen, mit Höhen und Mittellinien.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Lanes that are driven, their connectors, bicycle lanes and shoulders become lanelets; parking, hatched areas and medians do not. Where a lane begins beside another one, both are cut, so that neighbours share their border. Curbs are curbstone high or low, painted borders line_thin or line_thick, other edges road_border, and what is neither is virtual. Zebra crossings and stop lines come from the markings. What was inferred or bridged has the tags lanewright:status and lanewright:confidence, and lanewright:sigma_m is the uncertainty of the lane.</source>
            <translation>Befahrene Fahrstreifen, ihre Verbindungen, Radfahrstreifen und Seitenstreifen werden Lanelets; Parkstreifen, Sperrflächen und Mittelstreifen nicht. Wo ein Fahrstreifen neben einem anderen beginnt, werden beide geteilt, damit Nachbarn ihren Rand teilen. Borde sind curbstone high oder low, markierte Ränder line_thin oder line_thick, andere Ränder road_border, und was keines davon ist, virtual. Zebrastreifen und Haltlinien kommen aus den Markierungen. Was erschlossen oder überbrückt ist, trägt die Tags lanewright:status und lanewright:confidence, und lanewright:sigma_m ist die Unsicherheit des Fahrstreifens.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>The file is read back and checked before it is handed over; the report names the transformation to latitude and longitude and what the heights are. Traffic lights, signs, right of way and regulatory elements are not there.</source>
            <translation>Die Datei wird zurückgelesen und geprüft, bevor sie übergeben wird; der Bericht nennt die Transformation in Breite und Länge und was die Höhen sind. Ampeln, Schilder, Vorfahrt und Regelelemente sind nicht darin.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>osm</source>
            <translation>osm</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Autoware</source>
            <translation>Autoware</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>planner</source>
            <translation>Planer</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Speed limit (km/h)</source>
            <translation>Höchstgeschwindigkeit (km/h)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Written to every lanelet for vehicles. 0 writes none: the survey does not know it.</source>
            <translation>Steht an jedem Lanelet für Fahrzeuge. 0 schreibt keine: Die Vermessung kennt sie nicht.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Lanelets</source>
            <translation>Lanelets</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Ways</source>
            <translation>Wege</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Nodes</source>
            <translation>Knoten</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Findings of the check</source>
            <translation>Befunde der Prüfung</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Lanelet2 file</source>
            <translation>Lanelet2-Datei</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>The map.</source>
            <translation>Die Karte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Location</source>
            <translation>Lage</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Whether the roads are in a town; planners draw traffic rules from it.</source>
            <translation>Ob die Straßen innerorts liegen; Planer leiten Verkehrsregeln daraus ab.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Write local_x and local_y</source>
            <translation>local_x und local_y schreiben</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Autoware reads these metres within a square of 100 km instead of latitude and longitude.</source>
            <translation>Autoware liest diese Meter innerhalb eines Quadrats von 100 km anstelle von Breite und Länge.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>The layer of lanes has no CRS: the map has local coordinates, and latitudes and longitudes about 0.</source>
            <translation>Der Layer der Fahrstreifen hat kein KBS: Die Karte hat lokale Koordinaten sowie Breiten und Längen um 0.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>not stated</source>
            <translation>nicht angegeben</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>{count} lanelets; latitude and longitude by: {way}.</source>
            <translation>{count} Lanelets; Breite und Länge durch: {way}.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Transformation to latitude and longitude</source>
            <translation>Transformation nach Breite und Länge</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Accuracy of the transformation</source>
            <translation>Genauigkeit der Transformation</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Heights</source>
            <translation>Höhen</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Lanelet2 map</source>
            <translation>Lanelet2-Karte</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>{fault}: {count}</source>
            <translation>{fault}: {count}</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>{count} pieces of the type {kind} are no lanelets and were left out.</source>
            <translation>{count} Stücke vom Typ {kind} sind keine Lanelets und wurden weggelassen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Fault</source>
            <translation>Fehler</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_lanelet2.py" />
            <source>Count</source>
            <translation>Anzahl</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Export OpenDRIVE</source>
            <translation>OpenDRIVE exportieren</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Writes lanes as an OpenDRIVE map for simulators: roads with a reference line, lane sections, heights, road marks and junctions.</source>
            <translation>Schreibt Fahrstreifen als OpenDRIVE-Karte für Simulatoren: Straßen mit Referenzlinie, Abschnitten, Höhen, Markierungen und Knoten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>The reference line is made of lines, arcs and spirals, where the tolerance allows none of them of parametric cubics. Lanes beside each other are one road; a section begins where a lane begins or ends, and a junction where lanes part. Beside a double line lanes reach to its middle, where the mark of both stripes is. Widths are cubics, heights an elevation with superelevation or, on a crowned road, the shape of the cross-section. Connectors are the roads of junctions. Curbs are narrow lanes with their height; zebra crossings, stop lines, arrows and hatched areas are objects. What was inferred or bridged, and the uncertainty of every lane, is said in userData.</source>
            <translation>Die Referenzlinie besteht aus Geraden, Bögen und Klothoiden, wo die Toleranz keine davon zulässt aus parametrischen Polynomen dritten Grades. Fahrstreifen nebeneinander sind eine Straße; ein Abschnitt beginnt, wo ein Fahrstreifen beginnt oder endet, ein Knoten, wo Fahrstreifen auseinandergehen. An einer Doppellinie reichen die Fahrstreifen bis zu deren Mitte, wo die Markierung beider Striche liegt. Breiten sind Polynome dritten Grades, Höhen ein Höhenverlauf mit Querneigung oder, bei Dachprofil, die Form des Querschnitts. Verbindungen sind die Straßen der Knoten. Borde sind schmale Streifen mit ihrer Höhe; Zebrastreifen, Haltlinien, Pfeile und Sperrflächen sind Objekte. Was erschlossen oder überbrückt ist, und die Unsicherheit jedes Fahrstreifens, steht in userData.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>The file is read back and checked before it is handed over: the report says how far its borders lie from the survey's. OpenDRIVE stores no line to drive on; the report also says how far the middles of the lanes are from the driving lines. Signals, signs, speed limits and buildings are not there.</source>
            <translation>Die Datei wird zurückgelesen und geprüft, bevor sie übergeben wird: Der Bericht sagt, wie weit ihre Ränder von denen der Vermessung liegen. OpenDRIVE speichert keine Fahrlinie; der Bericht sagt auch, wie weit die Mitten der Fahrstreifen von den Fahrlinien liegen. Signale, Schilder, Geschwindigkeiten und Gebäude sind nicht darin.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>xodr</source>
            <translation>xodr</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>simulator</source>
            <translation>Simulator</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>CARLA</source>
            <translation>CARLA</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>esmini</source>
            <translation>esmini</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>How far borders may be missed, across and in height. Smaller follows the survey more closely with more and shorter elements.</source>
            <translation>Wie weit Ränder verfehlt werden dürfen, quer und in der Höhe. Kleiner folgt der Vermessung genauer, mit mehr und kürzeren Elementen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Junctions</source>
            <translation>Knoten</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Largest distance of a border from the survey's (m)</source>
            <translation>Größter Abstand eines Rands von dem der Vermessung (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Largest difference in height of a border (m)</source>
            <translation>Größter Höhenunterschied eines Rands (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>95th percentile of the distance of driving lines from the middles of lanes (m)</source>
            <translation>95. Perzentil des Abstands der Fahrlinien von den Mitten der Fahrstreifen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Borders, across</source>
            <translation>Grenzen, quer</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Borders, in height</source>
            <translation>Grenzen, in der Höhe</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Driving lines from the middles of lanes (measured)</source>
            <translation>Fahrlinien gegen die Mitten der Fahrstreifen (gemessene)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>The same, of lanes beside no double line</source>
            <translation>Dasselbe, von Fahrstreifen neben keiner Doppellinie</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>OpenDRIVE map</source>
            <translation>OpenDRIVE-Karte</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>OpenDRIVE file</source>
            <translation>OpenDRIVE-Datei</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Lanes of sections that are driven</source>
            <translation>Befahrene Streifen der Abschnitte</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>False origin</source>
            <translation>Verschobener Ursprung</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Against the survey</source>
            <translation>Gegen die Vermessung</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Elements of the reference lines</source>
            <translation>Elemente der Bezugslinien</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Version</source>
            <translation>Version</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Of the format; older simulators read 1.7.</source>
            <translation>Des Formats; ältere Simulatoren lesen 1.7.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Automatic takes it from roads with lanes in both directions; choose it where all roads are one-way.</source>
            <translation>Automatisch entnimmt sie Straßen mit Fahrstreifen in beiden Richtungen; wählen Sie sie, wo alle Straßen Einbahnstraßen sind.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>The layer of lanes has no CRS: the file has no geoReference.</source>
            <translation>Der Layer der Fahrstreifen hat kein KBS: Die Datei hat keine geoReference.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>none</source>
            <translation>keine</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Mean (m)</source>
            <translation>Mittel (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Largest (m)</source>
            <translation>Größter Wert (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Places</source>
            <translation>Stellen</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Element</source>
            <translation>Element</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>{roads} roads, {junctions} junctions; borders within {across:.3f} m of the survey's.</source>
            <translation>{roads} Straßen, {junctions} Knoten; Ränder innerhalb {across:.3f} m von denen der Vermessung.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/export_opendrive.py" />
            <source>Borders lie up to {across:.3f} m beside and {rise:.3f} m above or below those of the survey, more than the tolerance.</source>
            <translation>Ränder liegen bis zu {across:.3f} m neben und {rise:.3f} m über oder unter denen der Vermessung, mehr als die Toleranz.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_lanelet2.py" />
            <source>Import Lanelet2</source>
            <translation>Lanelet2 importieren</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_lanelet2.py" />
            <source>Reads a Lanelet2 map into layers like those of the road map, to lay it over a survey and assess it.</source>
            <translation>Liest eine Lanelet2-Karte in Layer wie die der Straßenkarte, um sie über eine Vermessung zu legen und zu bewerten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_lanelet2.py" />
            <source>Every lanelet becomes a lane between its two borders, with the lanelets that begin where it ends as successors. Footways, areas and regulatory elements are not read. Heights are the tag ele of the nodes, as they stand in the file.</source>
            <translation>Jedes Lanelet wird ein Fahrstreifen zwischen seinen zwei Rändern; ihm folgen die Lanelets, die an seinem Ende beginnen. Fußwege, Flächen und Regelelemente werden nicht gelesen. Höhen sind das Tag ele der Knoten, wie es in der Datei steht.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_lanelet2.py" />
            <source>Latitude and longitude are taken as WGS 84. A map with local_x and local_y alone, or whose latitudes and longitudes are all about 0, gets layers in local coordinates, without CRS.</source>
            <translation>Breite und Länge gelten als WGS 84. Eine Karte, die nur local_x und local_y hat oder deren Breiten und Längen alle um 0 liegen, ergibt Layer in lokalen Koordinaten, ohne KBS.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_lanelet2.py" />
            <source>A map with the ending .osm.</source>
            <translation>Eine Karte mit der Endung .osm.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_lanelet2.py" />
            <source>Projected, such as that of the survey. Empty takes the UTM zone of the map.</source>
            <translation>Projiziert, etwa das der Vermessung. Leer nimmt die UTM-Zone der Karte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_opendrive.py" />
            <source>Import OpenDRIVE</source>
            <translation>OpenDRIVE importieren</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_opendrive.py" />
            <source>Reads an OpenDRIVE map (1.1 to 1.8) into layers like those of the road map, to lay it over a survey and assess it.</source>
            <translation>Liest eine OpenDRIVE-Karte (1.1 bis 1.8) in Layer wie die der Straßenkarte, um sie über eine Vermessung zu legen und zu bewerten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_opendrive.py" />
            <source>Lines, arcs, spirals and polynomials of the reference line, elevation, superelevation and shape, lane offsets, widths and borders, road marks, heights of curbs and the links of lanes are read. Signals, objects, bridges, railways and the lines of their paint are not.</source>
            <translation>Gelesen werden Geraden, Bögen, Klothoiden und Polynome der Referenzlinie, Höhenverlauf, Querneigung und Querschnittsform, Versätze, Breiten und Ränder der Fahrstreifen, Markierungen, Bordhöhen und die Verknüpfungen der Fahrstreifen. Signale, Objekte, Brücken, Schienen und die Linien ihrer Markierung nicht.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_opendrive.py" />
            <source>Lanes of a section are a piece; lanes of roads in a junction are connectors. Sidewalks are no lanes: a road edge is drawn where one begins, with the height of its curb. Gaps of reference lines, borders that fold back in a tight curve, and widths below 0 are named with their road; folds are cut off. Files that declare entities, or are not what a map can be, are refused.</source>
            <translation>Der Fahrstreifen eines Abschnitts ist ein Stück; Fahrstreifen von Straßen in einem Knoten sind Verbindungen. Gehwege sind keine Fahrstreifen: Wo einer beginnt, wird ein Fahrbahnrand gezeichnet, mit der Höhe seines Bordsteins. Lücken von Referenzlinien, Grenzen, die sich in einer engen Kurve zurückfalten, und Breiten unter 0 werden mit ihrer Straße genannt; Falten werden abgeschnitten. Dateien, die Entitäten vereinbaren oder keine Karte sein können, werden abgelehnt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_opendrive.py" />
            <source>A map with the ending .xodr.</source>
            <translation>Eine Karte mit der Endung .xodr.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/import_opendrive.py" />
            <source>Only where the file does not say it in geoReference, or says it wrongly: the coordinates are taken to be in this CRS.</source>
            <translation>Nur wo die Datei es in geoReference nicht oder falsch sagt: Die Koordinaten gelten dann in diesem KBS.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>An area for each lane and piece, with the lanes that follow it.</source>
            <translation>Eine Fläche je Fahrstreifen und Stück, mit den Fahrstreifen, die ihm folgen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>The middle of every lane that is driven, in the direction of travel.</source>
            <translation>Die Mitte jedes befahrenen Fahrstreifens, in Fahrtrichtung.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>Borders that are painted.</source>
            <translation>Ränder, die markiert sind.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>Curbs and borders of the road.</source>
            <translation>Borde und Ränder der Straße.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>Lanes and pieces</source>
            <translation>Fahrstreifen und Stücke</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>Length of the driven lanes (m)</source>
            <translation>Länge der befahrenen Fahrstreifen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>Made by Driving lines or Road map, with its fields and heights.</source>
            <translation>Von Fahrlinien oder Straßenkarte erzeugt, mit Feldern und Höhen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>Held against the middles of the lanes: the report says how far apart they are. The uncertainty of every lane comes from them.</source>
            <translation>Werden mit den Mitten der Fahrstreifen verglichen: der Bericht sagt, wie weit sie auseinanderliegen. Die Unsicherheit jedes Fahrstreifens kommt aus ihnen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>The widths of the painted borders.</source>
            <translation>Die Breiten der markierten Ränder.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>The heights of curbs.</source>
            <translation>Die Höhen der Borde.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>Zebra crossings, stop lines, arrows and hatched areas.</source>
            <translation>Zebrastreifen, Haltlinien, Pfeile und Sperrflächen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>With it the borders have the heights of the road's surface.</source>
            <translation>Damit haben die Ränder die Höhen der Fahrbahn.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>CRS of the layers</source>
            <translation>KBS der Layer</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>{count} lanes and pieces, {length:.0f} m of driven lanes.</source>
            <translation>{count} Fahrstreifen und Stücke, {length:.0f} m befahrene Fahrstreifen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/export/inputs.py" />
            <source>{share:.0f} % of the border vertices have heights of road points.</source>
            <translation>{share:.0f} % der Stützpunkte der Ränder haben Höhen von Fahrbahnpunkten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Cross-sections</source>
            <translation>Querschnitte</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Measures width, crossfall, grade, rut depth, curb heights and clearance of every lane at fixed stations against limits.</source>
            <translation>Misst an festen Stationen Breite, Querneigung, Längsneigung, Spurrinnentiefe, Bordhöhen und lichte Höhe jedes Fahrstreifens und vergleicht sie mit Grenzwerten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Steps between scanners and passes are estimated where they overlap and taken off first. An error in roll looks like crossfall: passes in opposite directions tell the two apart, and where there are none the report says so and the sigma of the crossfall holds it.</source>
            <translation>Höhenstufen zwischen Scannern und Fahrten werden in ihren Überlappungen geschätzt und zuerst abgezogen. Ein Fehler im Rollwinkel sieht wie Querneigung aus: Fahrten in Gegenrichtung trennen beides; wo es keine gibt, sagt es der Bericht, und das Sigma der Querneigung enthält ihn.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Lanes are those of the layer Lanes, else of the driving lines between the marking lines, else of the marking lines alone; the carriageway ends at the road edges, else at the outermost line. Rut depths are measured under a straight edge of 2 m laid over profiles averaged over 1 m of road (over more where points are few), less what noise adds. Something that stands on the road does not count as hanging above it.</source>
            <translation>Fahrstreifen sind die des Layers Fahrstreifen, sonst die der Fahrlinien zwischen den Markierungslinien, sonst die der Markierungslinien allein; die Fahrbahn endet an den Fahrbahnrändern, sonst an der äußersten Linie. Spurrinnentiefen werden unter einer Latte von 2 m auf Profilen gemessen, die über 1 m Straße gemittelt sind (über mehr, wo Punkte rar sind), abzüglich dessen, was das Rauschen hinzufügt. Was auf der Straße steht, gilt nicht als darüber hängend.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>rutting</source>
            <translation>Spurrinnen</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>crossfall</source>
            <translation>Querneigung</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>superelevation</source>
            <translation>Überhöhung</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>clearance</source>
            <translation>lichte Höhe</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>road condition</source>
            <translation>Straßenzustand</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>width</source>
            <translation>Breite</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Interval of the sections (m)</source>
            <translation>Abstand der Querschnitte (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Smaller shows where a rut or a change of crossfall begins, but takes longer; below 10 m grade and ruts are measured over that length only.</source>
            <translation>Kleiner zeigt, wo eine Spurrinne oder ein Wechsel der Querneigung beginnt, dauert aber länger; unter 10 m werden Längsneigung und Spurrinnen nur über diese Länge gemessen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Whose rules give the limits that are left at 0, and whose usual lane is measured about the track where no layer of the road map is given. It is never guessed.</source>
            <translation>Dessen Regeln die Grenzwerte geben, die auf 0 stehen, und dessen üblicher Fahrstreifen um die Fahrspur gemessen wird, wo kein Layer der Straßenkarte angegeben ist. Es wird nie geraten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Rut depth at most, 0 = of the country (mm)</source>
            <translation>Spurrinnentiefe höchstens, 0 = des Landes (mm)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Deeper ruts under a straight edge of 2 m are marked. Lower finds shallow ones, down to what noise leaves, about 2 mm.</source>
            <translation>Tiefere Spurrinnen unter einer Latte von 2 m werden gekennzeichnet. Niedriger findet flache, bis zu dem, was das Rauschen lässt, etwa 2 mm.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Crossfall at least, 0 = of the country (%)</source>
            <translation>Querneigung mindestens, 0 = des Landes (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Lanes that fall less to either side are marked: water stands there. Lower leaves the places where the crossfall changes sides unmarked.</source>
            <translation>Fahrstreifen, die zu keiner Seite so stark fallen, werden gekennzeichnet: Dort steht Wasser. Niedriger lässt die Stellen ungekennzeichnet, an denen die Querneigung die Seite wechselt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Crossfall at most, 0 = of the country (%)</source>
            <translation>Querneigung höchstens, 0 = des Landes (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Steeper lanes are marked. Lower marks the superelevation of bends too.</source>
            <translation>Steilere Fahrstreifen werden gekennzeichnet. Niedriger kennzeichnet auch die Überhöhung von Kurven.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Grade at most, 0 = of the country (%)</source>
            <translation>Längsneigung höchstens, 0 = des Landes (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Steeper sections are marked, climbing or falling. Lower marks ramps too.</source>
            <translation>Steilere Querschnitte werden gekennzeichnet, steigend oder fallend. Niedriger kennzeichnet auch Rampen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Lane width at least, 0 = of the country (m)</source>
            <translation>Breite eines Fahrstreifens mindestens, 0 = des Landes (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Narrower driving lanes are marked. Higher marks turning lanes too.</source>
            <translation>Schmalere Fahrstreifen werden gekennzeichnet. Höher kennzeichnet auch Abbiegestreifen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Clearance at least, 0 = of the country (m)</source>
            <translation>Lichte Höhe mindestens, 0 = des Landes (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Sections with something hanging lower are marked. Higher finds branches above the traffic too.</source>
            <translation>Querschnitte, über denen etwas tiefer hängt, werden gekennzeichnet. Höher findet auch Äste über dem Verkehr.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>With it the carriageway ends at the edges, and heights of curbs are measured there.</source>
            <translation>Damit endet die Fahrbahn an den Rändern, und dort werden Bordhöhen gemessen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>With it lanes end at the painted lines.</source>
            <translation>Damit enden Fahrstreifen an den markierten Linien.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>With it lanes have their numbers and directions; not needed beside Lanes.</source>
            <translation>Damit haben Fahrstreifen ihre Nummern und Richtungen; neben Fahrstreifen nicht nötig.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>With it every lane, shoulder and parking strip of the road map is measured.</source>
            <translation>Damit wird jeder Fahr-, Seiten- und Parkstreifen der Straßenkarte gemessen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>A line across every lane and carriageway at every section.</source>
            <translation>An jedem Querschnitt eine Linie quer über jeden Fahrstreifen und die Fahrbahn.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Table of the cross-sections</source>
            <translation>Tabelle der Querschnitte</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>The same rows without lines, for spreadsheets.</source>
            <translation>Dieselben Zeilen ohne Linien, für Tabellenprogramme.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Sections</source>
            <translation>Querschnitte</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Lanes and carriageways that exceed a limit</source>
            <translation>Fahrstreifen und Fahrbahnen, die einen Grenzwert überschreiten</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Greatest rut depth (mm)</source>
            <translation>Größte Spurrinnentiefe (mm)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/cross_sections.py" />
            <source>Least clearance (m)</source>
            <translation>Kleinste lichte Höhe (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Roadside</source>
            <translation>Straßenseitenraum</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Finds guard rails, concrete barriers, walls, fences, hedges and gutters as lines, and poles, signs and tree trunks as points.</source>
            <translation>Findet Leitplanken, Betonschutzwände, Mauern, Zäune, Hecken und Rinnen als Linien sowie Masten, Schilder und Baumstämme als Punkte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>What repeats along the road at a steady offset and height is a line; its kind follows from its section: a beam with free height below, a face that leans back, an upright plane, something that is seen through, something rough. Buildings and rows of parked cars are none. Where a scanner sees hardly higher than it rides, as heads of many beams do, what is as high as it is left out: it may be a house front.</source>
            <translation>Was sich längs der Straße in gleichem Abstand und gleicher Höhe wiederholt, ist eine Linie; ihre Art folgt aus ihrem Querschnitt: ein Holm mit freiem Raum darunter, eine zurückgeneigte Fläche, eine senkrechte Ebene, etwas Durchsichtiges, etwas Raues. Gebäude und Reihen geparkter Autos sind keine. Wo ein Scanner kaum höher sieht, als er fährt, wie Köpfe mit vielen Strahlen, bleibt weg, was so hoch ist wie er: Es kann eine Hausfront sein.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Status says which pieces of a line were measured. Where something stands before it, as parked cars before a wall, and what is seen of it on both sides agrees in offset and height, it is one line, and the piece between them is bridged and drawn paler. Where the scanner saw through a gap, as through a gate or a driveway, nothing is drawn.</source>
            <translation>Status sagt, welche Stücke einer Linie gemessen sind. Wo etwas davor steht, wie parkende Autos vor einer Mauer, und das, was auf beiden Seiten von ihr zu sehen ist, in Versatz und Höhe übereinstimmt, ist es eine Linie, und das Stück dazwischen ist überbrückt und blasser gezeichnet. Wo der Scanner durch eine Lücke sah, wie durch ein Tor oder eine Einfahrt, wird nichts gezeichnet.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Only what stands outside the carriageway counts: give the road edges, or the layers of lines or lanes. Gutters are the lowest points along an edge that the road falls to; the higher side of a road has none.</source>
            <translation>Nur was außerhalb der Fahrbahn steht, zählt: Geben Sie die Fahrbahnränder an oder die Layer der Linien oder Fahrstreifen. Rinnen sind die tiefsten Punkte längs eines Randes, zu dem die Straße fällt; die höhere Seite einer Straße hat keine.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>guard rail</source>
            <translation>Leitplanke</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>barrier</source>
            <translation>Schutzwand</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>noise wall</source>
            <translation>Lärmschutzwand</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>fence</source>
            <translation>Zaun</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>hedge</source>
            <translation>Hecke</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>pole</source>
            <translation>Mast</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>sign</source>
            <translation>Schild</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>tree</source>
            <translation>Baum</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>asset</source>
            <translation>Straßenausstattung</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>street furniture</source>
            <translation>Straßenmöbel</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Longest interval between vertices (m)</source>
            <translation>Größter Abstand der Stützpunkte (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Lines have a vertex wherever they bend, and at least one every so many metres. Smaller gives more of them.</source>
            <translation>Linien haben einen Stützpunkt, wo sie abknicken, und mindestens einen je so viele Meter. Kleiner gibt mehr davon.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Whose lane widths tell two marking lines that bound a lane, where there are no road edges. It is never guessed.</source>
            <translation>Dessen Fahrstreifenbreiten zeigen, welche zwei Markierungslinien einen Fahrstreifen begrenzen, wo es keine Fahrbahnränder gibt. Es wird nie geraten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Reach beyond the carriageway's edge (m)</source>
            <translation>Reichweite jenseits des Fahrbahnrands (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Farther finds what stands behind verge and sidewalk, but also what belongs to the land beside the road.</source>
            <translation>Weiter findet, was hinter Bankett und Gehweg steht, aber auch, was zu den Grundstücken neben der Straße gehört.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Shortest line (m)</source>
            <translation>Kürzeste Linie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Shorter finds short pieces of rail and wall, but also cars and bins that stand in a row.</source>
            <translation>Kürzer findet kurze Stücke von Leitplanken und Mauern, aber auch Autos und Tonnen, die in einer Reihe stehen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Lowest line (m)</source>
            <translation>Niedrigste Linie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Lower finds low walls, but also high grass and steps.</source>
            <translation>Niedriger findet niedrige Mauern, aber auch hohes Gras und Stufen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Longest gap bridged (m)</source>
            <translation>Längste überbrückte Lücke (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Longer joins what follows in line; shorter tells more lines apart. What vehicles hide is bridged up to 12 m whatever this is, and an opening of 1.5 m or more through which the scanner saw is left open.</source>
            <translation>Länger verbindet, was in einer Flucht aufeinander folgt; kürzer unterscheidet mehr Linien. Was Fahrzeuge verdecken, wird bis 12 m überbrückt, gleich was hier steht, und eine Öffnung ab 1,5 m, durch die der Scanner sah, bleibt offen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Lowest pole, sign or trunk (m)</source>
            <translation>Niedrigster Mast, Schild oder Stamm (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Lower finds bollards and delineator posts, but also people.</source>
            <translation>Niedriger findet Poller und Leitpfosten, aber auch Menschen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>With it things are looked for from the edges outward, and gutters along them.</source>
            <translation>Damit wird von den Rändern nach außen gesucht, und Rinnen längs der Ränder.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>With it the carriageway without edges ends at the outermost line.</source>
            <translation>Damit endet die Fahrbahn ohne Ränder an der äußersten Linie.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>With it the carriageway without edges holds every lane.</source>
            <translation>Damit umfasst die Fahrbahn ohne Ränder jeden Fahrstreifen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>The same, with shoulders and parking strips.</source>
            <translation>Dasselbe, mit Seiten- und Parkstreifen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Pieces of lines along the foot, on the ground; those of one line have its number.</source>
            <translation>Stücke von Linien längs des Fußes, auf dem Gelände; die einer Linie haben deren Nummer.</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Poles, signs and trunks</source>
            <translation>Masten, Schilder und Stämme</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/roadside.py" />
            <source>Length of all lines but gutters (m)</source>
            <translation>Länge aller Linien außer Rinnen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/inventory/survey_with_borders.py" />
            <source>{label} holds no features and is not used.</source>
            <translation>{label} enthält keine Objekte und wird nicht verwendet.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>Cluster markings</source>
            <translation>Markierungen zusammenfassen</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>Gathers paint into markings, measures them and tells lines from crossings, arrows and the rest.</source>
            <translation>Fasst Farbe zu Markierungen zusammen, misst sie und unterscheidet Linien von Zebrastreifen, Pfeilen und dem Rest.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>The field class is edge, lane or centre for lines, and zebra, stop, give_way (a row of equal blocks across a lane), zigzag (a line along the road that turns back again and again: no stopping), arrow, bicycle, bus (the word BUS, its letters one marking), hatch or symbol for what is no line. A bicycle or a word that is not clearly seen stays symbol. Far from the vehicle, points join over the distance between the tracks of the scan.</source>
            <translation>Das Feld class ist edge, lane oder centre bei Linien und zebra, stop, give_way (eine Reihe gleicher Blöcke quer über einen Fahrstreifen), zigzag (eine Linie längs der Straße, die immer wieder umkehrt: Halten verboten), arrow, bicycle, bus (der Schriftzug BUS, seine Buchstaben eine Markierung), hatch oder symbol bei dem, was keine Linie ist. Ein Fahrrad oder ein Schriftzug, der nicht deutlich zu sehen ist, bleibt symbol. Fern vom Fahrzeug verbinden sich Punkte über den Abstand der Spuren des Scans.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>lane marking</source>
            <translation>Fahrbahnmarkierung</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>cluster</source>
            <translation>Gruppe</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>give-way line</source>
            <translation>Wartelinie</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>zigzag line</source>
            <translation>Zickzacklinie</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>zebra crossing</source>
            <translation>Zebrastreifen</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>stop line</source>
            <translation>Haltlinie</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>arrow</source>
            <translation>Pfeil</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>bicycle symbol</source>
            <translation>Fahrradsymbol</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>bus lane</source>
            <translation>Bussonderfahrstreifen</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>Distance that joins points (m)</source>
            <translation>Abstand, der Punkte verbindet (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>Larger joins worn paint into one marking, but also neighbouring markings; smaller keeps them apart.</source>
            <translation>Größer verbindet abgefahrene Farbe zu einer Markierung, aber auch benachbarte Markierungen; kleiner hält sie getrennt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>Fewest points of a marking (points)</source>
            <translation>Wenigste Punkte einer Markierung (Punkte)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>Fewer keeps tiny remains of paint, and specks that are none.</source>
            <translation>Weniger behält kleine Farbreste und Flecken, die keine sind.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>Marking points</source>
            <translation>Markierungspunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>The file written by Remove outliers or Extract markings.</source>
            <translation>Die von „Ausreißer entfernen“ oder „Markierungen extrahieren“ geschriebene Datei.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>Clustered points</source>
            <translation>Zusammengefasste Punkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/cluster_markings.py" />
            <source>The points with the extra field cluster.</source>
            <translation>Die Punkte mit dem zusätzlichen Feld cluster.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/correct_intensity.py" />
            <source>Correct intensity</source>
            <translation>Intensität korrigieren</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/correct_intensity.py" />
            <source>Evens out the fall of intensity with range and incidence, scanner by scanner, from the road's own asphalt.</source>
            <translation>Gleicht den Abfall der Intensität mit Entfernung und Einfallswinkel aus, Scanner für Scanner, am Asphalt der Straße selbst.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/correct_intensity.py" />
            <source>The raw intensity stays as it was; the corrected one is the extra field intensity_corrected, which later stages prefer.</source>
            <translation>Die rohe Intensität bleibt, wie sie war; die korrigierte steht im zusätzlichen Feld intensity_corrected, das spätere Stufen vorziehen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/correct_intensity.py" />
            <source>range correction</source>
            <translation>Entfernungskorrektur</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/correct_intensity.py" />
            <source>calibration</source>
            <translation>Kalibrierung</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/correct_intensity.py" />
            <source>Scale of the intensities</source>
            <translation>Skala der Intensitäten</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/correct_intensity.py" />
            <source>Linear ones are multiplied, logarithmic ones added to. Automatic goes by the spread of asphalt; choose one when the report names the wrong one.</source>
            <translation>Lineare werden multipliziert, zu logarithmischen wird addiert. Automatisch richtet sich nach der Streuung des Asphalts; eine wählen, wenn der Bericht die falsche nennt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/correct_intensity.py" />
            <source>The file written by Extract road surface.</source>
            <translation>Die von „Straßenoberfläche extrahieren“ geschriebene Datei.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/correct_intensity.py" />
            <source>Corrected road points</source>
            <translation>Korrigierte Straßenpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Extract markings</source>
            <translation>Markierungen extrahieren</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Separates paint from asphalt by intensity and keeps the points of the paint.</source>
            <translation>Unterscheidet Farbe an ihrer Intensität vom Asphalt und nimmt ihre Punkte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>paint</source>
            <translation>Farbe</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>threshold</source>
            <translation>Schwellwert</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>otsu</source>
            <translation>otsu</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>intensity peak</source>
            <translation>Intensitätsspitze</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>density</source>
            <translation>Dichte</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Method</source>
            <translation>Verfahren</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>multi-threshold sets a threshold for every strip along the road on the intensity image: the one to map with. The other two are published methods to compare with. intensity-peaks looks for narrow peaks in profiles across the road and finds lines only; point-segments sets thresholds on the points and keeps the dense ones. Neither tells concrete gutters from paint.</source>
            <translation>multi-threshold setzt auf dem Intensitätsbild für jeden Streifen längs der Straße einen Schwellwert: das Verfahren zum Kartieren. Die anderen beiden sind veröffentlichte Verfahren zum Vergleich. intensity-peaks sucht schmale Spitzen in Profilen quer zur Straße und findet nur Linien; point-segments setzt Schwellwerte auf den Punkten und behält die dichten. Keines der beiden unterscheidet Betonrinnen von Farbe.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Multi-threshold: least distance of paint from asphalt (σ)</source>
            <translation>Multi-threshold: geringster Abstand der Farbe vom Asphalt (σ)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>How many spreads of asphalt the paint of a strip must lie above it before the strip counts as painted. Lower finds fainter paint, but also gutters, patches and noise.</source>
            <translation>Um wie viele Streuungen des Asphalts die Farbe eines Streifens darüber liegen muss, damit er als bemalt gilt. Niedriger findet blassere Farbe, aber auch Rinnen, Flicken und Rauschen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Multi-threshold: shortest run of paint along the road (m)</source>
            <translation>Multi-threshold: kürzestes Stück Farbe längs der Straße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Longer removes specks, but also worn remains of dashes.</source>
            <translation>Länger entfernt Flecken, aber auch abgefahrene Reste von Strichen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Multi-threshold: gap in paint closed along the road (m)</source>
            <translation>Multi-threshold: längs der Straße geschlossene Lücke in der Farbe (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Longer joins worn paint, but also neighbouring bars and letters.</source>
            <translation>Länger verbindet abgefahrene Farbe, aber auch benachbarte Balken und Buchstaben.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Intensity peaks: length of a profile (m)</source>
            <translation>Intensity peaks: Länge eines Profils (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Longer holds more points and less noise, but blurs lines that are not parallel to the road. It should hold a scan line or two.</source>
            <translation>Länger enthält mehr Punkte und weniger Rauschen, verwischt aber Linien, die nicht parallel zur Straße sind. Es sollte eine oder zwei Scanlinien enthalten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Intensity peaks: least prominence of a peak (MAD)</source>
            <translation>Intensity peaks: geringste Höhe einer Spitze (MAD)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>How far a peak must rise above both its feet, in median absolute deviations of its profile. Lower finds fainter and worn lines, but also seams and noise.</source>
            <translation>Wie weit eine Spitze über ihre beiden Füße ragen muss, in mittleren absoluten Abweichungen ihres Profils. Niedriger findet blassere und abgefahrene Linien, aber auch Nähte und Rauschen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Intensity peaks: narrowest line (m)</source>
            <translation>Intensity peaks: schmalste Linie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Narrower peaks are no lines. Lower finds worn lines, but also cracks filled with light sealant.</source>
            <translation>Schmalere Spitzen sind keine Linien. Niedriger findet abgefahrene Linien, aber auch hell vergossene Risse.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Intensity peaks: widest line (m)</source>
            <translation>Intensity peaks: breiteste Linie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Broader peaks are no lines. Higher finds broad lines and zebra bars, but also pale repairs and gutters.</source>
            <translation>Breitere Spitzen sind keine Linien. Höher findet breite Linien und Zebrabalken, aber auch helle Flicken und Rinnen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Intensity peaks: shift between profiles (m)</source>
            <translation>Intensity peaks: Versatz zwischen Profilen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>How far across a peak may lie from the last one of its line. Larger follows slanting lines, but also joins what only happens to lie near.</source>
            <translation>Wie weit quer eine Spitze von der letzten ihrer Linie liegen darf. Größer folgt schrägen Linien, verbindet aber auch, was nur zufällig nahe liegt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Intensity peaks: gap along a line (m)</source>
            <translation>Intensity peaks: Lücke in einer Linie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Longer follows worn lines, but also joins specks. At least the length of a profile.</source>
            <translation>Länger folgt abgefahrenen Linien, verbindet aber auch Flecken. Mindestens die Länge eines Profils.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Intensity peaks: shortest line (m)</source>
            <translation>Intensity peaks: kürzeste Linie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Longer removes specks, but also short and worn dashes.</source>
            <translation>Länger entfernt Flecken, aber auch kurze und abgefahrene Striche.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Point segments: length of a segment (m)</source>
            <translation>Point segments: Länge eines Segments (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Longer holds more asphalt and steadies the threshold, but averages over patches and worn stretches.</source>
            <translation>Länger enthält mehr Asphalt und beruhigt den Schwellwert, mittelt aber über Flicken und abgefahrene Strecken.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Point segments: width of a segment (m)</source>
            <translation>Point segments: Breite eines Segments (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Narrower is scanned more alike, but may hold little asphalt beside the paint.</source>
            <translation>Schmaler ist gleichmäßiger gescannt, kann aber neben der Farbe wenig Asphalt enthalten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Point segments: least distance of paint from asphalt (σ)</source>
            <translation>Point segments: geringster Abstand der Farbe vom Asphalt (σ)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>How many spreads of asphalt the bright points of a segment must lie above the rest before it counts as painted. Lower finds fainter paint, but takes patches and noise for it.</source>
            <translation>Um wie viele Streuungen des Asphalts die hellen Punkte eines Segments über den übrigen liegen müssen, damit es als bemalt gilt. Niedriger findet blassere Farbe, hält aber auch Flicken und Rauschen dafür.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Point segments: radius in which bright points are counted (m)</source>
            <translation>Point segments: Umkreis, in dem helle Punkte gezählt werden (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Larger suits sparse surveys; smaller keeps narrow paint beside asphalt.</source>
            <translation>Größer passt zu dünnen Wolken; kleiner behält schmale Farbe neben Asphalt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>The file that the intensity image was made from.</source>
            <translation>Die Datei, aus der das Intensitätsbild entstand.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>The GeoTIFF written by Intensity image.</source>
            <translation>Das von „Intensitätsbild“ geschriebene GeoTIFF.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>Marking mask</source>
            <translation>Markierungsmaske</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/extract_markings.py" />
            <source>1 where a pixel is paint, 0 where it is not.</source>
            <translation>1, wo ein Pixel Farbe ist, 0, wo nicht.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Fit marking lines</source>
            <translation>Markierungslinien einpassen</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Links dashes along the road and fits a curve to every painted line.</source>
            <translation>Verbindet Striche längs der Straße und passt jeder aufgemalten Linie eine Kurve ein.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>lane line</source>
            <translation>Fahrstreifenlinie</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>curve fitting</source>
            <translation>Kurvenanpassung</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>spline</source>
            <translation>Spline</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Whose dashes are looked for. It is never guessed; neutral holds for roads of all countries of the catalogue.</source>
            <translation>Dessen Strichlängen gesucht werden. Es wird nie geraten; neutral gilt für Straßen aller Länder des Katalogs.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Curve fitted to marking lines</source>
            <translation>An Markierungslinien angepasste Kurve</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Automatic takes the simplest curve that fits (Bayesian information criterion). Choose one to force it on every line.</source>
            <translation>Automatisch nimmt die einfachste Kurve, die passt (Bayessches Informationskriterium). Eine wählen, um sie jeder Linie aufzuzwingen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Degree of the polynomial (0-9)</source>
            <translation>Grad des Polynoms (0-9)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Used with polynomial only. Higher follows more bends, but swings between its points.</source>
            <translation>Nur bei polynomial verwendet. Höher folgt mehr Bögen, schwingt aber zwischen seinen Punkten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Longest gap between dashes linked (m)</source>
            <translation>Längste Lücke zwischen verbundenen Strichen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Longer links dashes that stand far apart, but also lines that end and begin anew.</source>
            <translation>Länger verbindet weit auseinander liegende Striche, aber auch Linien, die enden und neu beginnen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Longest gap linked by rhythm (m)</source>
            <translation>Längste im Rhythmus verbundene Lücke (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Up to here a line goes on where its own rhythm of dashes or a line beside it carries over; flagged as bridged.</source>
            <translation>Bis hierher geht eine Linie weiter, wo ihr eigener Strichrhythmus oder eine Linie daneben hinüberträgt; als überbrückt gekennzeichnet.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Least paint of a line (m)</source>
            <translation>Wenigste Farbe einer Linie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Less makes lines of short remains, and of marks that are none.</source>
            <translation>Weniger macht Linien aus kurzen Resten und aus Zeichen, die keine sind.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>The file written by Cluster markings.</source>
            <translation>Die von „Markierungen zusammenfassen“ geschriebene Datei.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>The layer written by Cluster markings together with the points.</source>
            <translation>Der von „Markierungen zusammenfassen“ zusammen mit den Punkten geschriebene Layer.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>With it curbs help to tell edge lines from lane lines.</source>
            <translation>Damit helfen Bordsteine, Randlinien von Fahrstreifenlinien zu unterscheiden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>With it the width of the road helps to tell what a line separates.</source>
            <translation>Damit hilft die Breite der Straße zu erkennen, was eine Linie trennt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>Markings named by their lines</source>
            <translation>Markierungen, nach ihren Linien benannt</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/fit_marking_lines.py" />
            <source>The markings again, each dash and piece of a line with the class of the line that runs along it: alone, a dash of a centre line looks like any other.</source>
            <translation>Die Markierungen noch einmal, jeder Strich und jedes Stück einer Linie mit der Klasse der Linie, die an ihm entlangläuft: für sich sieht ein Strich einer Mittellinie aus wie jeder andere.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>Interpolates the intensity of road points into a GeoTIFF: near and bright points count more.</source>
            <translation>Interpoliert die Intensität der Straßenpunkte zu einem GeoTIFF: nahe und helle Punkte zählen mehr.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>image</source>
            <translation>Bild</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>orthophoto</source>
            <translation>Orthofoto</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>Smaller shows narrow lines more sharply while the cloud is dense enough; larger fills gaps and makes smaller files.</source>
            <translation>Kleiner zeigt schmale Linien schärfer, solange die Wolke dicht genug ist; größer füllt Lücken und macht kleinere Dateien.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>Power of the distance (0-9)</source>
            <translation>Potenz der Entfernung (0-9)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>Higher lets the nearest point decide, lower averages more.</source>
            <translation>Höher lässt den nächsten Punkt entscheiden, niedriger mittelt mehr.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>Share of the weight that follows brightness (0-1)</source>
            <translation>Anteil des Gewichts, der der Helligkeit folgt (0-1)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>0 is plain inverse distance; higher lets bright points count more and fattens paint by up to half a cell.</source>
            <translation>0 ist reine inverse Distanz; höher lässt helle Punkte mehr zählen und macht Farbe um bis zu eine halbe Zelle fetter.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>Reach of a point (cells)</source>
            <translation>Reichweite eines Punktes (Zellen)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>Larger fills sparse far pixels, but blurs.</source>
            <translation>Größer füllt dünn besetzte ferne Pixel, verwischt aber.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>The file written by Correct intensity, or by Extract road surface for the raw intensity.</source>
            <translation>Die von „Intensität korrigieren“ geschriebene Datei, oder die von „Straßenoberfläche extrahieren“ für die rohe Intensität.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>Intensity image, 8 bit</source>
            <translation>Intensitätsbild, 8 Bit</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/intensity_image.py" />
            <source>The same for viewing: stretched to 256 grey values, for programs that show no floating-point images.</source>
            <translation>Dasselbe zum Ansehen: auf 256 Graustufen gestreckt, für Programme, die keine Gleitkommabilder zeigen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>Remove outliers</source>
            <translation>Ausreißer entfernen</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>Statistical outlier removal: points that lie farther from their neighbours than is usual go.</source>
            <translation>Statistische Ausreißerentfernung: Punkte, die weiter von ihren Nachbarn liegen als üblich, gehen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>outlier</source>
            <translation>Ausreißer</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>noise</source>
            <translation>Rauschen</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>sor</source>
            <translation>sor</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>Nearest points looked at (points)</source>
            <translation>Betrachtete nächste Punkte (Punkte)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>More judges by a wider neighbourhood and removes small clumps too; fewer removes single points only.</source>
            <translation>Mehr urteilt nach einer weiteren Nachbarschaft und entfernt auch kleine Klumpen; weniger entfernt nur einzelne Punkte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>Allowed distance above the mean (σ)</source>
            <translation>Erlaubter Abstand über dem Mittel (σ)</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>Smaller removes more, first where points are sparse; larger keeps far paint, and some noise with it.</source>
            <translation>Kleiner entfernt mehr, zuerst wo Punkte dünn liegen; größer behält ferne Farbe, und etwas Rauschen mit ihr.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>Statistics over</source>
            <translation>Statistik über</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>All compares every point with the whole file, as PCL does, and eats sparse paint far from the scanner; windows compares it with its own stretch of the road.</source>
            <translation>All vergleicht jeden Punkt mit der ganzen Datei, wie PCL es tut, und frisst dünne Farbe fern vom Scanner; windows vergleicht ihn mit seinem eigenen Stück der Straße.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>The file written by Extract markings.</source>
            <translation>Die von „Markierungen extrahieren“ geschriebene Datei.</translation>
        </message>
        <message>
            <location filename="../../algorithms/markings/remove_outliers.py" />
            <source>Marking points without outliers</source>
            <translation>Markierungspunkte ohne Ausreißer</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/control_point_layer.py" />
            <source>{label}: the layer holds {kind} geometries. Control points are points, or a table.</source>
            <translation>{label}: der Layer enthält Geometrien der Art {kind}. Passpunkte sind Punkte oder eine Tabelle.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Georeference image</source>
            <translation>Bild georeferenzieren</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Places a UAV image on the map by ground control points, and reports its accuracy.</source>
            <translation>Bringt ein UAV-Bild über Passpunkte auf die Karte und sagt, wie gut es dort liegt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Control points come as a layer or as a file, each with pixel, line, easting and northing; pixel and line count from the outer corner of the first pixel. The result is a GeoTIFF in the CRS of the control points.</source>
            <translation>Passpunkte kommen als Layer oder als Datei, jeder mit Spalte (pixel), Zeile (line), Rechts- und Hochwert (easting, northing); gezählt wird ab der äußeren Ecke des ersten Pixels. Das Ergebnis ist ein GeoTIFF im KBS der Passpunkte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Spread the points over the whole image, its corners first: between them the polynomial is held, outside it runs away. Take twice as many as the order needs. Judge the result by check points, or by the error of each point without itself (leave-one-out), not by the residuals, which the polynomial was bent to make small. Control points taken from the point cloud tell how well the image fits the cloud, not how well either fits the ground.</source>
            <translation>Die Punkte über das ganze Bild verteilen, zuerst in die Ecken: zwischen ihnen ist das Polynom gehalten, außerhalb läuft es davon. Doppelt so viele nehmen, wie die Ordnung braucht. Das Ergebnis nach Prüfpunkten beurteilen oder nach dem Fehler jedes Punktes ohne ihn selbst, nicht nach den Restklaffungen, die das Polynom klein gebogen hat. Aus der Punktwolke entnommene Passpunkte sagen, wie gut das Bild zur Wolke passt, nicht wie gut eines von beiden auf dem Boden liegt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>UAV</source>
            <translation>UAV</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>drone</source>
            <translation>Drohne</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>orthoimage</source>
            <translation>Orthobild</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>GCP</source>
            <translation>Passpunkt</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>georeferencer</source>
            <translation>Georeferenzierung</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>warp</source>
            <translation>Entzerrung</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Order of the polynomial (0-3)</source>
            <translation>Ordnung des Polynoms (0-3)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>0 only shifts an image that already has a rough position; 1 also turns, scales and shears it (3 points or more), 2 also bends it (6), 3 bends it twice (10). Higher follows the points more closely and runs away faster outside them: watch the leave-one-out error, which falls only as long as the order is worth it.</source>
            <translation>0 verschiebt nur ein Bild, das schon eine grobe Lage hat; 1 dreht, skaliert und schert es auch (3 Punkte oder mehr), 2 biegt es auch (6), 3 biegt es zweimal (10). Höher folgt den Punkten genauer und läuft außerhalb schneller davon: auf den Fehler mit je einem weggelassenen Punkt achten, er fällt nur, solange die Ordnung es wert ist.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Pixel size (m)</source>
            <translation>Pixelgröße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Of the result; 0 keeps that of the image. Smaller makes a larger file, not a sharper image. A shift (order 0) of an image without position takes this as the image's own pixel size, north up.</source>
            <translation>Des Ergebnisses; 0 behält die des Bildes. Kleiner macht eine größere Datei, kein schärferes Bild. Eine Verschiebung (Ordnung 0) eines Bildes ohne Lage nimmt dies als Pixelgröße des Bildes selbst, Norden oben.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Outside the control points</source>
            <translation>Außerhalb der Passpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>What becomes of the image outside the hull of the control points, where the polynomial extrapolates: automatic draws it up to order 2 and leaves it out at order 3.</source>
            <translation>Was aus dem Bild außerhalb der Hülle der Passpunkte wird, wo das Polynom extrapoliert: automatisch zeichnet es bis Ordnung 2 und lässt es bei Ordnung 3 weg.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Resampling</source>
            <translation>Neuabtastung</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Bilinear is smooth and safe, cubic a little sharper, nearest keeps the values as they are (for classes and temperatures).</source>
            <translation>Bilinear ist glatt und sicher, cubic etwas schärfer, nearest behält die Werte, wie sie sind (für Klassen und Temperaturen).</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Disabled points are check points</source>
            <translation>Abgeschaltete Punkte sind Prüfpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Points that are switched off in the georeferencer, or have 0 in a column enable, judge the result instead of being passed over. A layer or CSV may name check points in a column role.</source>
            <translation>Punkte, die im Georeferenzierer abgeschaltet sind oder in einer Spalte enable 0 haben, beurteilen das Ergebnis, statt übergangen zu werden. Ein Layer oder eine CSV kann Prüfpunkte in einer Spalte role nennen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Control points</source>
            <translation>Passpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>RMSE of the control points (m)</source>
            <translation>RMSE der Passpunkte (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>RMSE of the control points, each left out in turn (m)</source>
            <translation>RMSE der Passpunkte, jeder der Reihe nach weggelassen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Check points</source>
            <translation>Prüfpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>RMSE of the check points (m)</source>
            <translation>RMSE der Prüfpunkte (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Largest residual of a control point (m)</source>
            <translation>Größte Restklaffung eines Passpunktes (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Image outside the hull of the control points (%)</source>
            <translation>Bild außerhalb der Hülle der Passpunkte (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Image</source>
            <translation>Bild</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>TIFF, JPEG, PNG or any other raster, with a position on the map or without.</source>
            <translation>TIFF, JPEG, PNG oder jedes andere Raster, mit Lage auf der Karte oder ohne.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Control points (layer)</source>
            <translation>Passpunkte (Layer)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>A point layer with the fields pixel and line, or a table that also has easting and northing. A field role (control or check) sets points aside that only judge the result, a field enable switches points off.</source>
            <translation>Ein Punktlayer mit den Feldern pixel und line, oder eine Tabelle, die auch easting und northing hat. Ein Feld role (control oder check) nimmt Punkte beiseite, die nur das Ergebnis beurteilen, ein Feld enable schaltet Punkte ab.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Georeferenced image</source>
            <translation>Georeferenziertes Bild</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>GeoTIFF with overviews; transparent or without data where the image ends.</source>
            <translation>GeoTIFF mit Übersichten; durchsichtig oder ohne Daten, wo das Bild endet.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Residuals</source>
            <translation>Restklaffungen</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>From where the polynomial puts each point to where it was measured.</source>
            <translation>Von dort, wohin das Polynom jeden Punkt setzt, dorthin, wo er gemessen wurde.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Control points (file)</source>
            <translation>Passpunkte (Datei)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>In place of a layer: the .points file of QGIS's georeferencer, the gcp_list.txt of OpenDroneMap, or a CSV with the columns pixel, line, easting, northing in any order. Where rows name images, those of this image are used.</source>
            <translation>Statt eines Layers: die .points-Datei des Georeferenzierers von QGIS, die gcp_list.txt von OpenDroneMap oder eine CSV mit den Spalten pixel, line, easting, northing in beliebiger Reihenfolge. Nennen die Zeilen Bilder, gelten die dieses Bildes.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>CRS of the control points</source>
            <translation>KBS der Passpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Only for control points that name none of their own. It must be projected.</source>
            <translation>Nur für Passpunkte, die selbst keines nennen. Es muss projiziert sein.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>The image has no position yet; the control points give it one. A line above, GDAL ERROR 1: Unable to compute a transformation, is QGIS saying the same and harmless.</source>
            <translation>Das Bild hat noch keine Lage; die Passpunkte geben ihm eine. Eine Zeile darüber, GDAL ERROR 1: Unable to compute a transformation, sagt dasselbe und ist harmlos.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Control points were given twice, as a layer and as a file. Leave one of them empty.</source>
            <translation>Passpunkte wurden zweimal angegeben, als Layer und als Datei. Eines davon leer lassen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>There are no control points. Choose a layer, or a .points or CSV file.</source>
            <translation>Es gibt keine Passpunkte. Einen Layer oder eine .points- oder CSV-Datei wählen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Control points: {count}, order {order}, RMSE {rmse:.3f} m, each left out in turn {left:.3f} m.</source>
            <translation>Passpunkte: {count}, Ordnung {order}, RMSE {rmse:.3f} m, jeder für sich weggelassen {left:.3f} m.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>The control points say that they are in {own}; the CRS given is for points that name none and was not used.</source>
            <translation>Die Passpunkte nennen {own} als ihr KBS; das angegebene ist für Punkte, die keines nennen, und wurde nicht verwendet.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/georeference_image.py" />
            <source>Check points: {count}, RMSE {rmse:.3f} m.</source>
            <translation>Prüfpunkte: {count}, RMSE {rmse:.3f} m.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Propose control points</source>
            <translation>Passpunkte vorschlagen</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Finds the same paint in a UAV image and in the intensity image, as control points for Georeference image.</source>
            <translation>Findet dieselbe Farbe in einem UAV-Bild und im Intensitätsbild, als Passpunkte für „Bild georeferenzieren“.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>The image needs a rough position: two given points, or a world file, or the position tags of the drone, or the size of its pixels. The paint of both images is laid over each other, the distortion of the camera followed, and about every corner of paint (ends of dashes, arrows, bars, stop lines) the two cut-outs are compared.</source>
            <translation>Das Bild braucht eine ungefähre Lage: zwei gegebene Punkte, eine World-Datei, die Positionsangaben der Drohne oder die Größe seiner Pixel. Die Farbe beider Bilder wird übereinandergelegt, der Verzeichnung der Kamera gefolgt, und um jede Ecke von Farbe (Enden von Strichen, Pfeile, Balken, Haltlinien) werden die beiden Ausschnitte verglichen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>A pair is accepted by default where its cut-outs look alike, nothing beside it looks the same, and the other pairs place it where it is. Where the paint repeats so that the whole image fits elsewhere as well, no pair is accepted and a warning says so. Look through the pairs with Control points from paint in the Lanewright menu, in the report, or in the table: points whose field accepted is 1 are used by Georeference image, others are not.</source>
            <translation>Ein Paar ist zunächst angenommen, wo seine Ausschnitte sich gleichen, nichts daneben genauso aussieht und die anderen Paare es an dieselbe Stelle legen. Wo sich die Farbe so wiederholt, dass das ganze Bild auch anderswo passt, wird kein Paar angenommen, und eine Warnung sagt es. Die Paare mit „Passpunkte aus Markierungen“ im Menü Lanewright durchsehen, im Bericht oder in der Tabelle: Punkte, deren Feld accepted 1 ist, verwendet „Bild georeferenzieren“, andere nicht.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>The pairs tell how well the image fits the point cloud, not how well either fits the ground. They lie on the road, so that the image is reliable there and less so beside it. Sun, shadow and dark paint do no harm; paint renewed between the two surveys does.</source>
            <translation>Die Paare sagen, wie gut das Bild zur Punktwolke passt, nicht wie gut eines von beiden auf dem Boden liegt. Sie liegen auf der Straße, dort ist das Bild verlässlich und daneben weniger. Sonne, Schatten und dunkle Farbe schaden nicht; zwischen beiden Aufnahmen erneuerte Farbe schadet.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>control points</source>
            <translation>Passpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>matching</source>
            <translation>Zuordnung</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>registration</source>
            <translation>Registrierung</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Pixel size of the image on the ground (m)</source>
            <translation>Pixelgröße des Bildes am Boden (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Roughly, to a tenth; 0 takes it from the image's position, or from the height and focal length in its tags. With it alone the whole intensity image is searched, in every direction.</source>
            <translation>Ungefähr, auf ein Zehntel; 0 nimmt sie aus der Lage des Bildes oder aus Höhe und Brennweite in seinen Angaben. Mit ihr allein wird das ganze Intensitätsbild in jeder Richtung abgesucht.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>How far the rough position may be off (m)</source>
            <translation>Wie weit die ungefähre Lage falsch sein darf (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Larger finds images with poor tags, takes longer, and meets more places that look alike on a road of equal dashes.</source>
            <translation>Mehr findet Bilder mit schlechten Angaben, dauert länger und trifft auf einer Straße mit gleichen Strichen mehr Stellen, die gleich aussehen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Largest distance from the other pairs (m)</source>
            <translation>Größter Abstand von den anderen Paaren (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>A pair is accepted where the others place it, to so much. Larger keeps pairs of an oblique image that a polynomial follows badly.</source>
            <translation>Ein Paar wird angenommen, wo die anderen es auf so viel genau hinlegen. Mehr behält Paare eines schrägen Bildes, dem ein Polynom schlecht folgt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Smallest likeness of two cut-outs (0-1)</source>
            <translation>Kleinste Ähnlichkeit zweier Ausschnitte (0-1)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Correlation, 1 for the same picture. Lower accepts worn paint and shadows, higher only what looks the same.</source>
            <translation>Korrelation, 1 bei gleichem Bild. Weniger nimmt abgenutzte Farbe und Schatten an, mehr nur, was gleich aussieht.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Most pairs that are accepted (points)</source>
            <translation>Höchstens angenommene Paare (Punkte)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>They are spread over the image. Half as many doubtful ones are listed besides.</source>
            <translation>Sie werden über das Bild verteilt. Halb so viele zweifelhafte werden daneben aufgeführt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Pairs proposed</source>
            <translation>Vorgeschlagene Paare</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Pairs accepted</source>
            <translation>Angenommene Paare</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>RMSE of the accepted pairs, each left out in turn (m)</source>
            <translation>RMSE der angenommenen Paare, jedes der Reihe nach weggelassen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Pixel of the image on the ground (m)</source>
            <translation>Pixel des Bildes am Boden (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Turn of the image, from its rows to east (°)</source>
            <translation>Drehung des Bildes, von seinen Zeilen nach Osten (°)</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>TIFF, JPEG, PNG or any other raster that looks straight down, of up to 500 m of ground.</source>
            <translation>TIFF, JPEG, PNG oder ein anderes Raster, senkrecht aufgenommen, bis 500 m Gelände.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>As Intensity image and Road map write it.</source>
            <translation>Wie „Intensitätsbild“ und „Straßenkarte“ es schreiben.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Two rough points</source>
            <translation>Zwei ungefähre Punkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>Where the image has no position: a layer with the fields pixel and line of two or more points far apart, right to some metres.</source>
            <translation>Wo das Bild keine Lage hat: ein Layer mit den Feldern pixel und line von zwei oder mehr weit auseinander liegenden Punkten, auf einige Meter richtig.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>As Georeference image takes them.</source>
            <translation>Wie „Bild georeferenzieren“ sie nimmt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>The image is looked for by {source}.</source>
            <translation>Das Bild wird gesucht nach: {source}.</translation>
        </message>
        <message>
            <location filename="../../algorithms/overlay/propose_control_points.py" />
            <source>{accepted} of {count} pairs accepted, RMSE {rmse:.3f} m, each left out in turn.</source>
            <translation>{accepted} von {count} Paaren angenommen, RMSE {rmse:.3f} m, jedes der Reihe nach weggelassen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/parameters.py" />
            <source>{label} ({name}) is {value}; it must be a number from {least:g} to {most:g}.</source>
            <translation>{label} ({name}) ist {value}; es muss eine Zahl von {least:g} bis {most:g} sein.</translation>
        </message>
        <message>
            <location filename="../../algorithms/parameters.py" />
            <source>{label} ({name}) is {value}; it must be one of {choices}.</source>
            <translation>{label} ({name}) ist {value}; möglich sind {choices}.</translation>
        </message>
        <message>
            <location filename="../../algorithms/progress.py" />
            <source>About {number} h left</source>
            <translation>Noch etwa {number} h</translation>
        </message>
        <message>
            <location filename="../../algorithms/progress.py" />
            <source>About {number} s left</source>
            <translation>Noch etwa {number} s</translation>
        </message>
        <message>
            <location filename="../../algorithms/progress.py" />
            <source>About {number} min left</source>
            <translation>Noch etwa {number} min</translation>
        </message>
        <message>
            <location filename="../../algorithms/report_head.py" />
            <source>as they are by default</source>
            <translation>wie voreingestellt</translation>
        </message>
        <message>
            <location filename="../../algorithms/report_head.py" />
            <source>Made</source>
            <translation>Ausgeführt</translation>
        </message>
        <message>
            <location filename="../../algorithms/report_head.py" />
            <source>Settings</source>
            <translation>Einstellungen</translation>
        </message>
        <message>
            <location filename="../../algorithms/report_head.py" />
            <source> and {count} more</source>
            <translation> und {count} weitere</translation>
        </message>
        <message>
            <location filename="../../algorithms/report_head.py" />
            <source>Warning</source>
            <translation>Warnung</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Boundaries from scanlines</source>
            <translation>Ränder aus Scanlinien</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Bottom and top corners of curbs on normalized scanlines, and the boundary lines through them.</source>
            <translation>Unter- und Oberkanten von Bordsteinen auf normalisierten Scanlinien, und die Randlinien durch sie.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>From the vehicle outward every scanline is searched for a step. About each step the points of the neighbouring scanlines give three planes: road, curb face and sidewalk. Where they meet the scanline's own plane lie the corners. Lines are cut by status: measured; bridged, a gap between corners; occluded, a gap that something hides.</source>
            <translation>Vom Fahrzeug nach außen wird jede Scanlinie nach einer Stufe abgesucht. Um jede Stufe geben die Punkte der benachbarten Scanlinien drei Ebenen: Straße, Bordsteinfläche und Gehweg. Wo sie die Ebene der Scanlinie treffen, liegen die Kanten. Linien sind nach status geschnitten: measured (gemessen); bridged, eine Lücke zwischen Kanten; occluded, eine Lücke, die etwas verdeckt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>boundary</source>
            <translation>Rand</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>scanline</source>
            <translation>Scanlinie</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>ransac</source>
            <translation>ransac</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>corner</source>
            <translation>Kante</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Search width across a step (m)</source>
            <translation>Suchbreite quer über eine Stufe (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>The height must change within this width. Wider finds rounded and bevelled curbs, but also ramps.</source>
            <translation>Die Höhe muss sich innerhalb dieser Breite ändern. Breiter findet gerundete und abgeschrägte Bordsteine, aber auch Rampen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Trajectory above the road, 0 = from the data (m)</source>
            <translation>Trajektorie über der Straße, 0 = aus den Daten (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Give it where little road was scanned under the vehicle; otherwise the data know better.</source>
            <translation>Angeben, wo unter dem Fahrzeug wenig Straße gescannt wurde; sonst wissen es die Daten besser.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Height above the road that is looked at (m)</source>
            <translation>Betrachtete Höhe über der Straße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Higher keeps curbs on steeply banked roads, but also low walls and the sills of cars.</source>
            <translation>Höher behält Bordsteine an stark geneigten Straßen, aber auch niedrige Mauern und die Schweller von Autos.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Reach of a plane across the road (m)</source>
            <translation>Reichweite einer Ebene quer zur Straße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Points this far to either side of a step give its planes. Longer is steadier, shorter keeps to narrow gutters and curb stones.</source>
            <translation>Punkte so weit zu beiden Seiten einer Stufe geben ihre Ebenen. Länger ist ruhiger, kürzer hält sich an schmale Rinnen und Bordsteine.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Reach of a plane along the road (m)</source>
            <translation>Reichweite einer Ebene längs der Straße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Longer is steadier where points are sparse, shorter follows sharp corners.</source>
            <translation>Länger ist ruhiger, wo Punkte dünn liegen, kürzer folgt scharfen Ecken.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Points of a plane lie within (m)</source>
            <translation>Punkte einer Ebene liegen innerhalb von (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Larger for noisy scanners; where points scatter more, 1.5 sigma of the plane is taken anyway.</source>
            <translation>Größer für rauschende Scanner; wo Punkte stärker streuen, werden ohnehin 1,5 Sigma der Ebene genommen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Least angle of a curb face's normal from the vertical, 0 = as the data allow (°)</source>
            <translation>Kleinster Winkel der Normalen der Bordfläche zur Senkrechten, 0 = wie es die Daten erlauben (°)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>90 is upright. As the data allow, 60 counts, and less, down to 25, where the face keeps its line for 10 m. A number is your own limit: lower accepts bevelled and mountable curbs (40 for a slope of 45°), but also banks.</source>
            <translation>90 ist aufrecht. Wie es die Daten erlauben zählen 60 und, wo die Fläche ihre Linie über 10 m hält, weniger bis 25. Eine Zahl ist die eigene Grenze: kleiner nimmt auch Schräg- und Flachborde (40 für eine Neigung von 45°), aber auch Böschungen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Largest angle of road's and sidewalk's normal from the vertical (°)</source>
            <translation>Größter Winkel der Normalen von Straße und Gehweg zur Senkrechten (°)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Larger accepts sloping ground behind the curb.</source>
            <translation>Größer nimmt geneigten Boden hinter dem Bordstein an.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Least height of a step, 0 = as the data allow (m)</source>
            <translation>Kleinste Höhe einer Stufe, 0 = wie es die Daten erlauben (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>As the data allow, 3 cm count, and less, down to 2 cm, where a step stands out from the noise and continues for 5 m. A number is your own limit: lower finds dropped curbs, but also tar seams and the edges of manholes.</source>
            <translation>Wie es die Daten erlauben zählen 3 cm und, wo eine Stufe aus dem Rauschen ragt und sich über 5 m fortsetzt, weniger bis 2 cm. Eine Zahl ist die eigene Grenze: kleiner findet abgesenkte Borde, aber auch Teernähte und Schachtränder.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Longest gap connected (m)</source>
            <translation>Längste verbundene Lücke (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Corners farther apart along the road are not joined. Longer passes driveways and parked cars, and says so.</source>
            <translation>Kanten, die längs der Straße weiter auseinander liegen, werden nicht verbunden. Länger geht über Einfahrten und parkende Autos hinweg und sagt es.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Least height of a step on scanlines, 0 = as the data allow (m)</source>
            <translation>Kleinste Höhe einer Stufe auf Scanlinien, 0 = wie es die Daten erlauben (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Lower finds dropped curbs, but also tar seams. Profiles have a minimum curb height of their own.</source>
            <translation>Niedriger findet abgesenkte Bordsteine, aber auch Teernähte. Profile haben eine eigene kleinste Bordsteinhöhe.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Normalized scanlines</source>
            <translation>Normalisierte Scanlinien</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>The layer written by Normalized scanlines.</source>
            <translation>Der von „Normalisierte Scanlinien“ geschriebene Layer.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Curb corners</source>
            <translation>Bordsteinkanten</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Bottoms and tops, one of each per half metre and side.</source>
            <translation>Unter- und Oberkanten, je eine je halbem Meter und Seite.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Road boundaries</source>
            <translation>Straßenränder</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/boundaries_from_scanlines.py" />
            <source>Bottom and top lines of either side.</source>
            <translation>Unter- und Oberkantenlinien jeder Seite.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_boundaries.py" />
            <source>Detect road boundaries</source>
            <translation>Straßenränder erkennen</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_boundaries.py" />
            <source>Road edges straight from the point clouds, by profiles, by scanlines or by both.</source>
            <translation>Straßenränder direkt aus den Punktwolken, über Profile, über Scanlinien oder über beide.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_boundaries.py" />
            <source>Where there is no curb the edge of the pavement is drawn: where asphalt ends at gravel, grass or a ditch, which are rougher, brighter, higher or lower than the road before them. The field edge tells the two apart (curb, pavement). Where nothing separates the road from what lies beside it, no edge is made up.</source>
            <translation>Wo kein Bordstein ist, wird der Rand der Fahrbahnbefestigung gezeichnet: wo der Asphalt an Schotter, Gras oder einem Graben endet, die rauer, heller, höher oder tiefer sind als die Straße davor. Das Feld edge unterscheidet beides (curb, pavement). Wo nichts die Straße von dem trennt, was neben ihr liegt, wird kein Rand erfunden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_boundaries.py" />
            <source>road edge</source>
            <translation>Fahrbahnrand</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_boundaries.py" />
            <source>Boundary method</source>
            <translation>Randverfahren</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_boundaries.py" />
            <source>Profiles looks for the curb in slices across the road; scanlines meets the planes of road, curb face and sidewalk; both lets the two check each other: at every place the one that measures better is drawn, agree_cm says how far apart they are, and it takes as long as the two together.</source>
            <translation>Profiles sucht den Bordstein in Scheiben quer zur Straße; scanlines schneidet die Ebenen von Straße, Bordsteinfläche und Gehweg; both lässt beide einander prüfen: an jeder Stelle wird gezeichnet, was besser misst, agree_cm sagt, wie weit sie auseinander liegen, und es dauert so lange wie beide zusammen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Detect curbs</source>
            <translation>Bordsteine erkennen</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Finds the curb nearest to the driven track on each side, on profiles across the road.</source>
            <translation>Findet auf Profilen quer zur Straße den Bordstein, der auf jeder Seite der gefahrenen Spur am nächsten liegt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Where there is no curb none is made up; a curb hidden behind parked cars becomes a point of status occluded. The field kind tells the road's own curbs (main) from those of corners, side streets and islands, which are found in plan.</source>
            <translation>Wo kein Bordstein ist, wird keiner erfunden; ein hinter parkenden Autos verborgener wird ein Punkt mit status occluded. Das Feld kind unterscheidet die Bordsteine der Straße selbst (main) von denen der Ecken, Seitenstraßen und Inseln, die im Grundriss gefunden werden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Block length along the road, 0 = automatic (m)</source>
            <translation>Blocklänge längs der Straße, 0 = automatisch (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Automatic takes 0.5 m in sharp curves and up to 2 m on straights. Shorter follows a bend more closely but has fewer points to go by.</source>
            <translation>Automatisch nimmt 0,5 m in scharfen Bögen und bis 2 m auf Geraden. Kürzer folgt einem Bogen genauer, hat aber weniger Punkte, nach denen es gehen kann.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Profile width along the road (m)</source>
            <translation>Profilbreite längs der Straße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Wider finds curbs far from the scanner, where points are sparse, but blurs them in bends.</source>
            <translation>Breiter findet Bordsteine fern vom Scanner, wo Punkte dünn liegen, verwischt sie aber in Bögen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Cell across the road (m)</source>
            <translation>Zelle quer zur Straße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Finer places the curb more exactly; coarser fills gaps in sparse clouds, but misses low curbs.</source>
            <translation>Feiner setzt den Bordstein genauer; gröber füllt Lücken in dünnen Wolken, verpasst aber niedrige Bordsteine.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Height gap between layers (m)</source>
            <translation>Höhensprung zwischen Schichten (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Points of a cell this far apart in height belong to different things: the road and a car above it. Smaller cuts the curb off grass and cars, but also splits noisy ground.</source>
            <translation>Punkte einer Zelle, die in der Höhe so weit auseinander liegen, gehören zu verschiedenen Dingen: zur Straße und zu einem Auto darüber. Kleiner trennt den Bordstein von Gras und Autos, zerteilt aber auch rauschenden Boden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Smallest slope of the curb face, 0 = as the data allow (°)</source>
            <translation>Kleinste Neigung der Bordfläche, 0 = wie es die Daten erlauben (°)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>As the data allow, faces of 60° count, and less steep ones, down to 25°, where they keep their line for 10 m. A number is your own limit: lower accepts short bevelled and worn curbs, but also verges and ramps.</source>
            <translation>Wie es die Daten erlauben zählen Flächen von 60° und, wo sie ihre Linie über 10 m halten, flachere bis 25°. Eine Zahl ist die eigene Grenze: kleiner nimmt auch kurze Schrägborde und abgenutzte, aber auch Bankette und Rampen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Minimum curb height, 0 = as the data allow (m)</source>
            <translation>Kleinste Bordsteinhöhe, 0 = wie es die Daten erlauben (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>As the data allow, curbs of 5 cm count, and lower ones, down to 2 cm, where they stand out from the noise and continue for 5 m. With a noisy scanner, curbs dropped to 1 cm are followed from the end of a sure one. A number is your own limit: lower finds dropped curbs at driveways, but also tar seams and gutters.</source>
            <translation>Wie es die Daten erlauben zählen Borde von 5 cm und, wo sie aus dem Rauschen ragen und sich über 5 m fortsetzen, niedrigere bis 2 cm. Bei einem verrauschten Scanner werden auf 1 cm abgesenkte Borde vom Ende eines sicheren aus verfolgt. Eine Zahl ist die eigene Grenze: kleiner findet abgesenkte Borde an Einfahrten, aber auch Teernähte und Rinnen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Maximum curb height (m)</source>
            <translation>Größte Bordsteinhöhe (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Higher accepts platforms and low walls as the road's edge.</source>
            <translation>Höher nimmt Bahnsteige und niedrige Mauern als Straßenrand an.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>Principal points</source>
            <translation>Hauptpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/detect_curbs.py" />
            <source>The highest point of the lowest layer of every cell: what the curbs were looked for on.</source>
            <translation>Der höchste Punkt der untersten Schicht jeder Zelle: worauf die Bordsteine gesucht wurden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/extract_road_surface.py" />
            <source>Extract road surface</source>
            <translation>Straßenoberfläche extrahieren</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/extract_road_surface.py" />
            <source>Keeps the points of the road surface: between the road edges, or as far as the ground stays smooth.</source>
            <translation>Behält die Punkte der Straßenoberfläche: zwischen den Straßenrändern, oder so weit der Boden glatt bleibt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/extract_road_surface.py" />
            <source>road surface</source>
            <translation>Fahrbahn</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/extract_road_surface.py" />
            <source>ground</source>
            <translation>Boden</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/extract_road_surface.py" />
            <source>Farthest surface from the trajectory (m)</source>
            <translation>Fernste Oberfläche von der Trajektorie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/extract_road_surface.py" />
            <source>On a side without an edge the surface grows outward while it stays smooth, at most this far. Wider reaches the far lanes of a broad road, but also yards and forecourts.</source>
            <translation>Auf einer Seite ohne Rand wächst die Oberfläche nach außen, solange sie glatt bleibt, höchstens so weit. Weiter erreicht die fernen Fahrstreifen einer breiten Straße, aber auch Höfe und Vorplätze.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/extract_road_surface.py" />
            <source>Height about the road's own surface (m)</source>
            <translation>Höhe um die Fläche der Straße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/extract_road_surface.py" />
            <source>Wider keeps noisy points and ruts, but also the feet of cars and curbs; where the scanner's noise allows, less is taken.</source>
            <translation>Weiter behält rauschende Punkte und Spurrinnen, aber auch die Füße von Autos und Bordsteinen; wo das Rauschen des Scanners es erlaubt, wird weniger genommen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/extract_road_surface.py" />
            <source>The layer written by Fit road edges. Without it the surface is grown on both sides.</source>
            <translation>Der von „Straßenränder einpassen“ geschriebene Layer. Ohne ihn wächst die Oberfläche auf beiden Seiten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/extract_road_surface.py" />
            <source>Class 11, with the extra fields road, pass, station_m, offset_m, half_width and covered for the stages that follow.</source>
            <translation>Klasse 11, mit den zusätzlichen Feldern road, pass, station_m, offset_m, half_width und covered für die folgenden Stufen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/fit_road_edges.py" />
            <source>Fit road edges</source>
            <translation>Straßenränder einpassen</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/fit_road_edges.py" />
            <source>Draws the road edges through curb points as smoothing splines, bridging short gaps and saying so.</source>
            <translation>Zeichnet die Straßenränder als glättende Splines durch Bordsteinpunkte, überbrückt kurze Lücken und sagt es.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/fit_road_edges.py" />
            <source>Longer carries the edge past rows of parked cars, flagged as bridged; shorter breaks it there. Where both parts of the curb lie in one line, gaps up to twice as long are bridged.</source>
            <translation>Länger führt den Rand an Reihen parkender Autos vorbei, als überbrückt gekennzeichnet; kürzer unterbricht ihn dort. Wo beide Teile des Bordsteins in einer Linie liegen, werden bis zu doppelt so lange Lücken überbrückt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/fit_road_edges.py" />
            <source>Assumed road width where no curb is seen, 0 = none (m)</source>
            <translation>Angenommene Straßenbreite, wo kein Bordstein zu sehen ist, 0 = keine (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/fit_road_edges.py" />
            <source>0 draws no edge where none was found. A width draws one at half of it either side of the road's reference line, flagged as inferred.</source>
            <translation>0 zeichnet keinen Rand, wo keiner gefunden wurde. Eine Breite zeichnet einen in halber Breite beiderseits der Bezugslinie der Straße, als erschlossen gekennzeichnet.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/fit_road_edges.py" />
            <source>The layer written by Detect curbs.</source>
            <translation>Der von „Bordsteine erkennen“ geschriebene Layer.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Cuts the measured surface by planes across the road, one scanline for every plane, pass and scanner.</source>
            <translation>Schneidet die gemessene Oberfläche mit Ebenen quer zur Straße, eine Scanlinie für jede Ebene, jede Befahrung und jeden Scanner.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>The lines of a rotating scanner are told apart by the times and places of the points alone; neighbouring lines make the surface that is cut. Where it is interrupted, behind a car say, a new scanline begins. Points without times, or of a head with many beams, have no such lines: there the points near each plane make the scanline, and the log says so.</source>
            <translation>Die Linien eines rotierenden Scanners werden allein aus Zeiten und Orten der Punkte erkannt; benachbarte Linien ergeben die Oberfläche, die geschnitten wird. Wo sie unterbrochen ist, etwa hinter einem Auto, beginnt eine neue Scanlinie. Punkte ohne Zeiten oder von einem Kopf mit vielen Strahlen haben keine solchen Linien: dort bilden die Punkte nahe jeder Ebene die Scanlinie, und das Protokoll sagt es.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>cross section</source>
            <translation>Querschnitt</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>resample</source>
            <translation>Neuabtastung</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Interval of section planes along the road (m)</source>
            <translation>Abstand der Schnittebenen längs der Straße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Smaller gives more scanlines, and more of them than were measured where scan lines lie far apart; larger is quicker.</source>
            <translation>Kleiner ergibt mehr Scanlinien, und mehr als gemessen wurden, wo Scanlinien weit auseinander liegen; größer ist schneller.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Corridor either side of the road's reference line (m)</source>
            <translation>Korridor beiderseits der Bezugslinie der Straße (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Wider reaches the far side of a broad avenue, but takes longer.</source>
            <translation>Weiter erreicht die ferne Seite einer breiten Allee, dauert aber länger.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Scan lines of each scanner, 0 = from the data (per second)</source>
            <translation>Scanlinien jedes Scanners, 0 = aus den Daten (je Sekunde)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>The data know it well. Give it where they are said to show no regular scan lines although the scanner has a rotating mirror; the direction of rotation is found anyway.</source>
            <translation>Die Daten wissen es gut. Angeben, wo sie angeblich keine regelmäßigen Scanlinien zeigen, obwohl der Scanner einen rotierenden Spiegel hat; die Drehrichtung wird ohnehin gefunden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Deviation allowed in thinning the scanlines (m)</source>
            <translation>Erlaubte Abweichung beim Ausdünnen der Scanlinien (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Larger draws and writes faster and shows less of the surface; 0 keeps every vertex.</source>
            <translation>Größer zeichnet und schreibt schneller und zeigt weniger von der Oberfläche; 0 behält jeden Stützpunkt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Spacing of resampled points along a scanline (m)</source>
            <translation>Abstand der neu abgetasteten Punkte längs einer Scanlinie (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Smaller gives more points, without more being known of the surface.</source>
            <translation>Kleiner ergibt mehr Punkte, ohne dass mehr von der Oberfläche bekannt wäre.</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Lines with height (Z) and intensity (M).</source>
            <translation>Linien mit Höhe (Z) und Intensität (M).</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Resampled points</source>
            <translation>Neu abgetastete Punkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/road/normalized_scanlines.py" />
            <source>Points at equal steps along the scanlines, with intensity, station and offset: a cloud of even density.</source>
            <translation>Punkte in gleichen Schritten längs der Scanlinien, mit Intensität, Station und Abstand: eine Wolke gleichmäßiger Dichte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>Estimate trajectory</source>
            <translation>Trajektorie schätzen</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>Where the scanner was, from the point clouds alone, for surveys that come without a trajectory.</source>
            <translation>Wo der Scanner war, allein aus den Punktwolken, für Vermessungen ohne Trajektorie.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>Every return lies on the ray that the scanner's mirror had at its time. All rays together tell where the scanner was, how it was turned and how it is mounted; what stands along the road does not matter. This takes clouds from vehicles with rotating mirrors, whole, with the gps_time of every point; lines or points may be thinned out.</source>
            <translation>Jeder Messpunkt liegt auf dem Strahl, den der Spiegel des Scanners zu seiner Zeit hatte. Alle Strahlen zusammen sagen, wo der Scanner war, wie er gedreht war und wie er eingebaut ist; was an der Straße steht, ist gleichgültig. Das braucht Wolken von Fahrzeugen mit rotierenden Spiegeln, vollständig, mit der gps_time jedes Punktes; Zeilen oder Punkte dürfen ausgedünnt sein.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>The positions are those of the scanner, of the middle between several: where the vehicle's own trajectory refers to another place of the vehicle, the two differ by a constant arm. Heading, roll and pitch are relative to the way driven and the road. What a cloud is displaced by as a whole does not show in it, nor in the uncertainty.</source>
            <translation>Die Positionen sind die des Scanners, bei mehreren die ihrer Mitte: Bezieht sich die Trajektorie des Fahrzeugs auf eine andere Stelle am Fahrzeug, so unterscheiden sich beide um einen festen Hebelarm. Kurswinkel, Roll- und Nickwinkel gelten gegenüber dem gefahrenen Weg und der Straße. Worum eine Wolke als Ganzes verschoben ist, zeigt sich weder in ihr noch in der Unsicherheit.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>Heads of many beams that turn about an upright axis are known by their turns: their place is that from which every return lies in the direction of its time. Their height above the road is that from which every beam has one elevation, on whatever it falls; where too little stands beside the road to tell it, it is a usual one, known to 0.5 m, and the log says so.</source>
            <translation>Köpfe mit vielen Strahlen, die um eine stehende Achse rotieren, werden an ihren Umdrehungen erkannt: Ihr Ort ist der, von dem aus jeder Punkt in der Richtung seiner Zeit liegt. Ihre Höhe über der Straße ist die, von der aus jeder Strahl überall dieselbe Neigung hat, worauf er auch fällt; wo zu wenig an der Straße steht, um sie zu erkennen, ist es eine übliche, auf 0,5 m bekannt, und das Protokoll sagt es.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>Without gps_time, or where no mirror is seen to turn, the track follows the density of the points: it is rough, half a metre off and with a height known to 0.3 m, and says so. Airborne, terrestrial and handheld clouds are refused, and so are those that lack the road under the vehicle and files of drives whose clocks overlap.</source>
            <translation>Ohne gps_time, oder wo kein Spiegel zu erkennen ist, der sich dreht, folgt die Spur der Punktdichte: Sie ist grob, einen halben Meter ungenau und in der Höhe auf 0,3 m bekannt, und es wird gesagt. Wolken aus der Luft, vom Stativ und aus der Hand werden abgelehnt, ebenso solche, denen die Straße unter dem Fahrzeug fehlt, und Dateien von Fahrten, deren Uhren sich überschneiden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>trajectory</source>
            <translation>Trajektorie</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>no trajectory</source>
            <translation>keine Trajektorie</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>scanner position</source>
            <translation>Scannerposition</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>rotating mirror</source>
            <translation>rotierender Spiegel</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>gps time</source>
            <translation>GPS-Zeit</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>Positions</source>
            <translation>Positionen</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>Length driven (m)</source>
            <translation>Gefahrene Länge (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>Scanners that took part</source>
            <translation>Beteiligte Scanner</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>Uncertainty of the place, median (m)</source>
            <translation>Unsicherheit der Lage, Median (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/estimate_trajectory.py" />
            <source>Uncertainty of the height, median (m)</source>
            <translation>Unsicherheit der Höhe, Median (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>Import trajectory</source>
            <translation>Trajektorie einlesen</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>Reads the driven trajectory from a CSV or TXT file, an Applanix SBET, a log or track of a receiver, or a point or line layer.</source>
            <translation>Liest die gefahrene Trajektorie aus einer CSV- oder TXT-Datei, einem Applanix-SBET, einem Protokoll oder Track eines Empfängers oder einem Punkt- oder Linienlayer.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>Columns may come in any order, with or without a header, in degrees, radians or degrees with minutes and seconds. Rows are sorted by time; repeated and unusable rows are dropped and counted. The dialog shows what was understood of a file, and lets you assign its columns.</source>
            <translation>Spalten dürfen in beliebiger Reihenfolge stehen, mit oder ohne Kopfzeile, in Grad, Radiant oder Grad mit Minuten und Sekunden. Zeilen werden nach der Zeit sortiert; doppelte und unbrauchbare Zeilen fallen weg und werden gezählt. Der Dialog zeigt, was von einer Datei verstanden wurde, und lässt ihre Spalten zuordnen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>Times are GPS seconds. Clock times are read where the file says what the clock shows: GPS time as it is, UTC with the leap seconds of its date. Other clock times, and seconds since 1970, are refused, as their leap seconds are unknown.</source>
            <translation>Zeiten sind GPS-Sekunden. Uhrzeiten werden gelesen, wo die Datei sagt, was die Uhr zeigt: GPS-Zeit, wie sie ist, UTC mit den Schaltsekunden des Datums. Andere Uhrzeiten und Sekunden seit 1970 werden abgelehnt, da ihre Schaltsekunden nicht bekannt sind.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>sbet</source>
            <translation>sbet</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>applanix</source>
            <translation>applanix</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>csv</source>
            <translation>csv</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>nmea</source>
            <translation>nmea</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>gpx</source>
            <translation>gpx</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>rtklib</source>
            <translation>rtklib</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>Imported trajectory</source>
            <translation>Eingelesene Trajektorie</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>Trajectory file or layer</source>
            <translation>Datei oder Layer der Trajektorie</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>A CSV or TXT file, an SBET (.out), a log (NMEA, RTKLIB, NovAtel), a GPX or KML track, or a layer of points or lines with heights.</source>
            <translation>Eine CSV- oder TXT-Datei, ein SBET (.out), ein Protokoll (NMEA, RTKLIB, NovAtel), ein Track (GPX, KML) oder ein Layer aus Punkten oder Linien mit Höhen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>Columns</source>
            <translation>Spalten</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>Of a text file, one word a column from the left: time, x, y, z, roll, pitch, heading, lon, lat, or - for a column that is left out; such as time,y,x,z. A column of clock times is gps or utc, by what its clock shows, and week or date where these stand apart. Empty recognises them by their names, or by their numbers where they have none.</source>
            <translation>Einer Textdatei, ein Wort je Spalte von links: time, x, y, z, roll, pitch, heading, lon, lat oder - für eine Spalte, die wegbleibt; etwa time,y,x,z. Eine Spalte mit Uhrzeiten ist gps oder utc, je nachdem, was die Uhr zeigt, und week oder date, wo diese für sich stehen. Leer werden sie an ihren Namen erkannt oder, wo sie keine haben, an ihren Zahlen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>CRS of the trajectory</source>
            <translation>KBS der Trajektorie</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>Where the file does not say it. An SBET is in WGS 84 unless another is chosen.</source>
            <translation>Wo die Datei es nicht sagt. Ein SBET ist in WGS 84, wenn kein anderes gewählt wird.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>CRS to bring it to</source>
            <translation>Ziel-KBS</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>That of the point clouds. Empty takes it from the point clouds below, or leaves the trajectory as it is.</source>
            <translation>Das der Punktwolken. Leer nimmt es aus den Punktwolken unten oder lässt die Trajektorie, wie sie ist.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>With them the time system is told apart, and the trajectory is written on the clouds' clock.</source>
            <translation>Mit ihnen wird das Zeitsystem erkannt, und die Trajektorie wird in der Zeit der Wolken geschrieben.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>The trajectory names no CRS and none was given, so its layer has none: set CRS of the trajectory, or CRS to bring it to where the coordinates are in that of the point clouds.</source>
            <translation>Die Trajektorie nennt kein KBS und es wurde keines angegeben, also hat ihr Layer keines: „KBS der Trajektorie“ setzen, oder „Ziel-KBS“, wenn ihre Koordinaten schon in dem der Punktwolken stehen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/import_trajectory.py" />
            <source>Trajectory: {count} positions.</source>
            <translation>Trajektorie: {count} Positionen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Inspect survey</source>
            <translation>Vermessung prüfen</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Reports what point clouds and trajectory contain, and whether they fit together, before any processing.</source>
            <translation>Sagt, was Punktwolken und Trajektorie enthalten und ob sie zueinander passen, bevor an ihnen gearbeitet wird.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>What the road map would stumble over, such as a geographic CRS or two clocks, is said with a way on.</source>
            <translation>Worüber die Straßenkarte stolpern würde, etwa ein geographisches KBS oder zwei Uhren, wird gesagt, mit einem Ausweg.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>report</source>
            <translation>Bericht</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>las</source>
            <translation>las</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>header</source>
            <translation>Kopfdaten</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>overlap</source>
            <translation>Überlappung</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Cell of the density raster (m)</source>
            <translation>Zelle des Dichterasters (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Smaller shows single scan lines, larger the broad picture.</source>
            <translation>Kleiner zeigt einzelne Scanlinien, größer das große Bild.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Cube that the density in space is counted in (m)</source>
            <translation>Würfel, in dem die räumliche Dichte gezählt wird (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>1 gives points per cubic metre as they are published; smaller ones follow surfaces more closely.</source>
            <translation>1 gibt Punkte je Kubikmeter, wie sie veröffentlicht werden; kleinere folgen Oberflächen genauer.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Points</source>
            <translation>Punkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Points per m², mean of occupied cells</source>
            <translation>Punkte je m², Mittel der besetzten Zellen</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Points per m³, mean of occupied cubes</source>
            <translation>Punkte je m³, Mittel der besetzten Würfel</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>First gps_time (s)</source>
            <translation>Erste gps_time (s)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Last gps_time (s)</source>
            <translation>Letzte gps_time (s)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Scanners</source>
            <translation>Scanner</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Points near the trajectory (%)</source>
            <translation>Punkte nahe der Trajektorie (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Scan time covered by the trajectory (%)</source>
            <translation>Von der Trajektorie abgedeckte Scanzeit (%)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Point density</source>
            <translation>Punktdichte</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Points per m² in every cell.</source>
            <translation>Punkte je m² in jeder Zelle.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Survey: {count} points in {files} file(s), {density:.0f} points per m² where there are any, {scanners} scanner(s), intensities {darkest} to {brightest}.</source>
            <translation>Vermessung: {count} Punkte in {files} Datei(en), {density:.0f} Punkte je m², wo welche sind, {scanners} Scanner, Intensitäten {darkest} bis {brightest}.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/inspect_survey.py" />
            <source>Trajectory: {near:.0f} % of the points lie within {metres:.0f} m of it.</source>
            <translation>Trajektorie: {near:.0f} % der Punkte liegen innerhalb von {metres:.0f} m.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Sample survey</source>
            <translation>Beispielvermessung</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Simulates a mobile laser scanning survey of a street, motorway, junction or mountain road, together with its known truth.</source>
            <translation>Simuliert die mobile Laserscan-Vermessung einer Straße, Autobahn, Kreuzung oder Bergstraße, zusammen mit ihrer bekannten Wahrheit.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Every pulse of two scanners is followed to what it meets first. Figures reached on it are figures on simulated data.</source>
            <translation>Jeder Puls zweier Scanner wird verfolgt, bis er auf etwas trifft. Darauf erreichte Zahlen sind Zahlen auf simulierten Daten.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>sample</source>
            <translation>Beispiel</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>simulation</source>
            <translation>Simulation</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>test data</source>
            <translation>Testdaten</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Scene</source>
            <translation>Szene</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>street: two lanes in bends, with curbs and parked cars. rural: a country road without curbs. urban: four lanes with gutters. one-lane and wide-lane: a single lane of 5.8 or 7 m with arrows in its middle. no-centre-line: two lanes without a line between them. hatched-island: two directions held apart by a hatched area. motorway: two lanes and a hard shoulder each way, and an exit. serpentine: a steep road with hairpins. crossing: four arms with turning lanes, one of them not driven. roundabout: a ring with splitter islands, driven straight on and to the left. outskirts: two lanes with guard rail, concrete barrier, walls, fences and a hedge beside them, driven both ways. cycle-lanes: two lanes with the word BUS, and cycle lanes with bicycles.</source>
            <translation>street: zwei Fahrstreifen in Bögen, mit Bordsteinen und parkenden Autos. rural: eine Landstraße ohne Bordsteine. urban: vier Fahrstreifen mit Rinnen. one-lane und wide-lane: ein einziger Fahrstreifen von 5,8 oder 7 m mit Pfeilen in seiner Mitte. no-centre-line: zwei Fahrstreifen ohne Linie dazwischen. hatched-island: zwei Richtungen, von einer Sperrfläche getrennt. motorway: zwei Fahrstreifen und ein Standstreifen je Richtung, mit einer Ausfahrt. serpentine: eine steile Straße mit Kehren. crossing: vier Arme mit Abbiegestreifen, einer davon nicht befahren. roundabout: ein Kreisverkehr mit Fahrbahnteilern, geradeaus und nach links befahren. outskirts: zwei Fahrstreifen mit Leitplanke, Betonschutzwand, Mauern, Zäunen und einer Hecke daneben, in beiden Richtungen befahren. cycle-lanes: zwei Fahrstreifen mit dem Schriftzug BUS und Radfahrstreifen mit Fahrrädern.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Length of the road, 0: as usual for the scene (m)</source>
            <translation>Länge der Straße, 0: wie bei der Szene üblich (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Longer takes longer to make and to work through, in proportion. Streets are usually 120 m long, a motorway 240 m (600 m at the most), a serpentine 200 m (1000 m), a crossing and a roundabout 110 m from end to end (300 m).</source>
            <translation>Länger dauert im selben Verhältnis länger, beim Erzeugen wie beim Verarbeiten. Straßen sind gewöhnlich 120 m lang, eine Autobahn 240 m (höchstens 600 m), eine Serpentine 200 m (1000 m), Kreuzung und Kreisverkehr 110 m von Ende zu Ende (300 m).</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Seed of the random numbers (whole number)</source>
            <translation>Startwert der Zufallszahlen (ganze Zahl)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Another seed gives another street with other cars, wear and noise; the same seed gives the same points.</source>
            <translation>Ein anderer Startwert ergibt eine andere Straße mit anderen Autos, anderer Abnutzung und anderem Rauschen; derselbe ergibt dieselben Punkte.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Speed of the vehicle (km/h)</source>
            <translation>Geschwindigkeit des Fahrzeugs (km/h)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Faster spreads the scan lines wider apart.</source>
            <translation>Schneller legt die Scanlinien weiter auseinander.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Pulses of each scanner (per second)</source>
            <translation>Pulse jedes Scanners (je Sekunde)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>More gives a denser cloud and a larger file.</source>
            <translation>Mehr ergibt eine dichtere Wolke und eine größere Datei.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Scan lines of each scanner (per second)</source>
            <translation>Scanlinien jedes Scanners (je Sekunde)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>More brings the lines closer together, with fewer points on each.</source>
            <translation>Mehr bringt die Linien näher zusammen, mit weniger Punkten auf jeder.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Scanners' planes turned from straight across (°)</source>
            <translation>Verdrehung der Scanebenen gegen die Querrichtung (°)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>0 scans straight across the road; more sees the faces of things from ahead and behind, one scanner either way.</source>
            <translation>0 scannt gerade quer zur Straße; mehr sieht die Flächen der Dinge von vorn und von hinten, ein Scanner jeweils.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Radius of the bends (m)</source>
            <translation>Radius der Bögen (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Smaller makes sharper bends; motorway, serpentine, crossing and roundabout have bends of their own.</source>
            <translation>Kleiner ergibt schärfere Bögen; motorway, serpentine, crossing und roundabout haben ihre eigenen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Height of the curbs (m)</source>
            <translation>Höhe der Bordsteine (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Lower is harder to find.</source>
            <translation>Niedriger ist schwerer zu finden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Width of a concrete gutter along the curbs (m)</source>
            <translation>Breite einer Betonrinne längs der Bordsteine (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>A gutter is as bright as paint and is not to be taken for it; 0 leaves it out.</source>
            <translation>Eine Rinne ist so hell wie Farbe und darf nicht dafür gehalten werden; 0 lässt sie weg.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>True road boundaries</source>
            <translation>Wahre Straßenränder</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>True markings</source>
            <translation>Wahre Markierungen</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>True driving lines</source>
            <translation>Wahre Fahrlinien</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>True road surface</source>
            <translation>Wahre Straßenoberfläche</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>True lanes</source>
            <translation>Wahre Fahrstreifen</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>True roadside</source>
            <translation>Wahrer Straßenseitenraum</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Point cloud</source>
            <translation>Punktwolke</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>UAV image</source>
            <translation>UAV-Bild</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>What a UAV sees of the first 150 m: a TIFF of 4 cm pixels without a place on the map, with the distortion of its camera and the position tags of a drone. Propose control points and Georeference image find its place. There is none of motorway, serpentine, crossing and roundabout.</source>
            <translation>Was ein UAV von den ersten 150 m sieht: ein TIFF mit Pixeln von 4 cm ohne Lage auf der Karte, mit der Verzeichnung seiner Kamera und den Positionsangaben einer Drohne. „Passpunkte vorschlagen“ und „Bild georeferenzieren“ finden seine Lage. Von motorway, serpentine, crossing und roundabout gibt es keines.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Ground control points of the UAV image</source>
            <translation>Passpunkte des UAV-Bildes</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>CRS of the survey</source>
            <translation>KBS der Vermessung</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>A projected CRS in metres. The coordinates are the same in each; it only says where on earth they are.</source>
            <translation>Ein projiziertes KBS in Metern. Die Koordinaten sind in jedem dieselben; es sagt nur, wo auf der Erde sie liegen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey/sample_survey.py" />
            <source>Sample survey: {count} points along {length:.0f} m of road.</source>
            <translation>Beispielvermessung: {count} Punkte entlang {length:.0f} m Straße.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Left out, it is estimated from the points (see Estimate trajectory).</source>
            <translation>Fehlt sie, wird sie aus den Punkten geschätzt (siehe „Trajektorie schätzen“).</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Points farther out are left unread. Wider reaches the far side of a broad avenue, but takes longer and brings in the neighbouring street.</source>
            <translation>Punkte weiter außen werden nicht gelesen. Weiter erreicht die ferne Seite einer breiten Allee, dauert aber länger und holt die Nachbarstraße herein.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Field that tells the scanners apart</source>
            <translation>Feld, das die Scanner unterscheidet</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Automatic takes scanner_channel where it is used and point_source_id where it interleaves in time, or along the road where the points have no times; where no field tells them apart, they are told apart by their scan lines. Name one when the report counts the wrong number of scanners.</source>
            <translation>Automatisch nimmt scanner_channel, wo es benutzt wird, und point_source_id, wo es zeitlich verschränkt ist oder, bei Punkten ohne Zeiten, entlang der Straße; wo kein Feld sie unterscheidet, werden sie an ihren Scanzeilen unterschieden. Ein Feld angeben, wenn der Bericht die falsche Zahl von Scannern nennt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Time of the trajectory</source>
            <translation>Zeit der Trajektorie</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>How its clock counts: gps (since 1980), adjusted (the same less a billion), week or day. Automatic compares with the point clouds and says what it chose.</source>
            <translation>Wie ihre Uhr zählt: gps (seit 1980), adjusted (dasselbe weniger eine Milliarde), week oder day. Automatisch vergleicht mit den Punktwolken und sagt, was gewählt wurde.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Intensity from</source>
            <translation>Intensität aus</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Where the points have no intensity but colours, rgb takes the brightness of their colours in its place (0.2126 red, 0.7152 green, 0.0722 blue). It is a substitute: shadows and vehicles on the photographs darken and cover paint, and what the camera saw is displaced where it was not well aligned with the scanner.</source>
            <translation>Wo die Punkte keine Intensität, aber Farben haben, nimmt rgb an ihrer Stelle die Helligkeit der Farben (0,2126 Rot, 0,7152 Grün, 0,0722 Blau). Das ist ein Ersatz: Schatten und Fahrzeuge auf den Fotos verdunkeln und verdecken Farbe auf der Straße, und was die Kamera sah, ist versetzt, wo sie nicht gut auf den Scanner ausgerichtet war.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Lay passes over one road on each other</source>
            <translation>Befahrungen derselben Straße aufeinanderlegen</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Where two drives over a road measurably lie centimetres apart, as navigation drifts between them, each is moved by its share until curbs and paint agree, and the log says how far. Off keeps every point where it was measured, for surveys adjusted to control points already; what the passes differ by then blurs curbs and doubles lines.</source>
            <translation>Wo zwei Befahrungen einer Straße messbar Zentimeter auseinanderliegen, weil die Navigation zwischen ihnen driftet, wird jede um ihren Anteil verschoben, bis Bordsteine und Farbe übereinstimmen; das Protokoll sagt, um wie viel. Ausgeschaltet bleibt jeder Punkt, wo er gemessen wurde: für Vermessungen, die schon an Passpunkten ausgeglichen sind. Worin die Befahrungen sich dann unterscheiden, macht Bordsteine unscharf und Linien doppelt.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Accuracy of the trajectory across, one sigma, 0 = unknown (m)</source>
            <translation>Genauigkeit der Trajektorie quer, ein Sigma, 0 = unbekannt (m)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>How far the survey as a whole may lie beside its true place, as the processing of GNSS and INS reports it or check points show; 0.02 is usual. It goes into sigma_m of road edges and driving lines, which then tells how far they may lie beside their true place. With 0 it tells how well they fit the survey's own points, and what passes differ by; what the survey is off as a whole, which one drive does not show, comes on top.</source>
            <translation>Wie weit die Vermessung als Ganzes neben ihrer wahren Lage liegen kann, wie es die Auswertung von GNSS und INS angibt oder Kontrollpunkte zeigen; 0,02 ist üblich. Es geht in sigma_m der Straßenränder und Fahrlinien ein, das dann sagt, wie weit sie neben ihrer wahren Lage liegen können. Bei 0 sagt es, wie gut sie zu den Punkten der Vermessung passen und worin sich Befahrungen unterscheiden; was die Vermessung als Ganzes abweicht und eine einzelne Befahrung nicht zeigt, kommt hinzu.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Worker processes, 0 = automatic (whole number)</source>
            <translation>Arbeitsprozesse, 0 = automatisch (ganze Zahl)</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>So many further processes of Python read the points, find curbs and do most of what is done point by point, with the same results. More are faster as long as there are processor cores for them, and each takes some hundred MB of memory. Automatic takes one for every 8 million points, eight or one per core at most, and none for less than 24 million points, nor on two cores for less than 100 million. Where no Python can be started, this program does their work, and the log says so.</source>
            <translation>So viele weitere Python-Prozesse lesen die Punkte, suchen Bordsteine und erledigen das meiste, was Punkt für Punkt getan wird, mit denselben Ergebnissen. Mehr sind schneller, solange es Prozessorkerne für sie gibt; jeder braucht einige hundert MB Speicher. Automatisch ist einer je 8 Millionen Punkte, höchstens einer je Kern und höchstens acht, keiner bei weniger als 24 Millionen Punkten, auf zwei Kernen bei weniger als 100 Millionen. Wo sich kein Python starten lässt, übernimmt dieses Programm ihre Arbeit, und das Protokoll sagt es.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Address of a Dask scheduler</source>
            <translation>Adresse eines Dask-Schedulers</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>The workers of a Dask cluster that is running already do what worker processes would, with the same results: tls://host:8786, or tcp://127.0.0.1:8786 on this computer. They need the same Python, packages and Lanewright, no QGIS, and a work folder that all machines see. The manual's page on large surveys tells how to start one. Worker processes are not used then.</source>
            <translation>Die Worker eines bereits laufenden Dask-Clusters tun, was weitere Prozesse täten, mit denselben Ergebnissen: tls://rechner:8786, oder tcp://127.0.0.1:8786 auf diesem Rechner. Sie brauchen dasselbe Python, dieselben Pakete und dasselbe Lanewright, kein QGIS, und einen Arbeitsordner, den alle Rechner sehen. Wie man einen startet, steht im Handbuch unter „Große Vermessungen“. Weitere Prozesse werden dann nicht verwendet.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Connect without encryption</source>
            <translation>Unverschlüsselt verbinden</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Whoever can reach an unencrypted cluster can run programs on it. Set this only in a network that is yours alone; on this computer it is not needed.</source>
            <translation>Wer einen unverschlüsselten Cluster erreicht, kann Programme auf ihm ausführen. Nur in einem Netz einschalten, das Ihnen allein gehört; auf diesem Rechner ist es nicht nötig.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>No trajectory was given; it is estimated from the points …</source>
            <translation>Es wurde keine Trajektorie angegeben; sie wird aus den Punkten geschätzt …</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>Work folder</source>
            <translation>Arbeitsordner</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>A folder for finished work, about 20 bytes for every point near the road. A run that ended early, or that is repeated with other settings of later stages, does not read the points and find the curbs again. What was made from other files, settings or another version of Lanewright is not used. Nothing that is finished is ever removed; delete it when the map is done.</source>
            <translation>Ein Ordner für fertige Arbeit, etwa 20 Byte je Punkt nahe der Straße. Ein Lauf, der vorzeitig endete oder mit anderen Einstellungen späterer Stufen wiederholt wird, liest die Punkte nicht noch einmal und sucht die Bordsteine nicht noch einmal. Was aus anderen Dateien, Einstellungen oder mit einer anderen Version von Lanewright entstand, wird nicht verwendet. Nichts Fertiges wird je gelöscht; löschen Sie ihn, wenn die Karte fertig ist.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>The points</source>
            <translation>Die Punkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>The trajectory says no CRS; its coordinates are taken to be those of the target CRS as they are.</source>
            <translation>Die Trajektorie nennt kein KBS; ihre Koordinaten werden unverändert als die des Ziel-KBS genommen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>{path} has no intensity (all values are the same), so paint cannot be told from asphalt. Road edges and surface need none; for markings, export the point clouds with intensity, or, where they have colours, make these points again with Intensity from (INTENSITY_FROM) set to rgb.</source>
            <translation>{path} hat keine Intensität (alle Werte sind gleich), daher lässt sich Markierung nicht von Asphalt unterscheiden. Straßenränder und Oberfläche brauchen keine; für Markierungen die Punktwolken mit Intensität exportieren oder, wo sie Farben haben, diese Punkte neu erzeugen und dabei Intensität aus (INTENSITY_FROM) auf rgb setzen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/survey_input.py" />
            <source>{label} holds no points: no paint was found on this road.</source>
            <translation>{label} enthält keine Punkte: auf dieser Straße wurde keine Farbe gefunden.</translation>
        </message>
        <message>
            <location filename="../../algorithms/trajectory_source.py" />
            <source>{label} has no rows. Choose the layer that holds the driven positions.</source>
            <translation>{label} hat keine Zeilen. Den Layer wählen, der die gefahrenen Positionen enthält.</translation>
        </message>
        <message>
            <location filename="../../algorithms/vector_source.py" />
            <source>too few vertices</source>
            <translation>zu wenige Stützpunkte</translation>
        </message>
        <message>
            <location filename="../../algorithms/vector_source.py" />
            <source>coordinates that lie nowhere on earth</source>
            <translation>Koordinaten, die nirgends auf der Erde liegen</translation>
        </message>
        <message>
            <location filename="../../algorithms/vector_source.py" />
            <source>{label} cannot be used: {count} of its {total} features have {problem}, the first of them feature {id}. Repair or delete them.</source>
            <translation>{label} lässt sich nicht verwenden: {count} von {total} Objekten haben {problem}, das erste davon ist Objekt {id}. Sie reparieren oder löschen.</translation>
        </message>
        <message>
            <location filename="../../algorithms/vector_source.py" />
            <source>{label} lacks the field(s) {fields}. Use the layer that Lanewright wrote.</source>
            <translation>{label} fehlen die Felder {fields}. Den Layer verwenden, den Lanewright geschrieben hat.</translation>
        </message>
        <message>
            <location filename="../../algorithms/vector_source.py" />
            <source>{label} holds geometries of the kind {found}; {needed} is needed. Use the layer that Lanewright wrote.</source>
            <translation>{label} enthält Geometrien der Art {found}; gebraucht wird {needed}. Den Layer verwenden, den Lanewright geschrieben hat.</translation>
        </message>
        <message>
            <location filename="../../algorithms/vector_source.py" />
            <source>{label} has geometries without heights (Z) or measures (M). Use the layer that Lanewright wrote.</source>
            <translation>{label} hat Geometrien ohne Höhen (Z) oder Messwerte (M). Den Layer verwenden, den Lanewright geschrieben hat.</translation>
        </message>
        <message>
            <location filename="../../algorithms/vector_source.py" />
            <source>{label} has {value!r} in its field {field}, where a number is needed. Use the layer that Lanewright wrote.</source>
            <translation>{label} hat {value!r} im Feld {field}, wo eine Zahl gebraucht wird. Den Layer verwenden, den Lanewright geschrieben hat.</translation>
        </message>
        <message>
            <location filename="../../algorithms/vector_source.py" />
            <source>{label} has geometries without heights (Z). Use the layer that Lanewright wrote.</source>
            <translation>{label} hat Geometrien ohne Höhen (Z). Den Layer verwenden, den Lanewright geschrieben hat.</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>measured</source>
            <translation>gemessen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>bridged</source>
            <translation>überbrückt</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>inferred</source>
            <translation>erschlossen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>hidden</source>
            <translation>verdeckt</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>grown</source>
            <translation>gewachsen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>accepted</source>
            <translation>bestätigt</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>drawn</source>
            <translation>gezeichnet</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>unknown</source>
            <translation>unbekannt</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>together</source>
            <translation>zusammen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>carriageway</source>
            <translation>Fahrbahn</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>dropped curb</source>
            <translation>abgesenkter Bordstein</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>edge of the pavement</source>
            <translation>Rand der Befestigung</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>main carriageway</source>
            <translation>durchgehende Fahrbahn</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>corner of a curb</source>
            <translation>Bordsteinecke</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>side street</source>
            <translation>Seitenstraße</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>island</source>
            <translation>Insel</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Zebra crossing</source>
            <translation>Zebrastreifen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Stop line</source>
            <translation>Haltlinie</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Give-way line</source>
            <translation>Wartelinie</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Zigzag line</source>
            <translation>Zickzacklinie</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Arrow</source>
            <translation>Pfeil</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Symbol</source>
            <translation>Symbol</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Hatching</source>
            <translation>Schraffur</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Bicycle symbol</source>
            <translation>Fahrradsymbol</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Word BUS</source>
            <translation>Schriftzug BUS</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>marking</source>
            <translation>Markierung</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>other paint</source>
            <translation>andere Farbe</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>solid</source>
            <translation>durchgezogen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>dashed</source>
            <translation>gestrichelt</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>double, solid</source>
            <translation>doppelt, durchgezogen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>double, dashed</source>
            <translation>doppelt, gestrichelt</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>solid and dashed</source>
            <translation>durchgezogen und gestrichelt</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>dashed and solid</source>
            <translation>gestrichelt und durchgezogen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>between two lines</source>
            <translation>zwischen zwei Linien</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>beside one line</source>
            <translation>neben einer Linie</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Driving lane</source>
            <translation>Fahrstreifen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Shoulder</source>
            <translation>Seitenstreifen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Parking</source>
            <translation>Parkstreifen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Bicycle lane</source>
            <translation>Radfahrstreifen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Hatched area</source>
            <translation>Sperrfläche</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Median</source>
            <translation>Mittelstreifen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Connector over a junction</source>
            <translation>Verbindung über eine Kreuzung</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>accept</source>
            <translation>bestätigen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>delete</source>
            <translation>löschen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>move</source>
            <translation>verschieben</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>ahead</source>
            <translation>vorn</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>behind</source>
            <translation>hinten</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>above</source>
            <translation>oberhalb</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>below</source>
            <translation>unterhalb</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Wall</source>
            <translation>Mauer</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Gutter</source>
            <translation>Rinne</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Tree trunk</source>
            <translation>Baumstamm</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>rut depth</source>
            <translation>Spurrinnentiefe</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>grade</source>
            <translation>Längsneigung</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>correct</source>
            <translation>richtig</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>missed</source>
            <translation>verpasst</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>false</source>
            <translation>falsch</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>excluded</source>
            <translation>ausgenommen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Control point</source>
            <translation>Passpunkt</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Check point</source>
            <translation>Prüfpunkt</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Disabled point</source>
            <translation>Abgeschalteter Punkt</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>start</source>
            <translation>Anfang</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>end</source>
            <translation>Ende</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>arc</source>
            <translation>Kreisbogen</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>parametric cubic</source>
            <translation>parametrische Kubik</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Edge line</source>
            <translation>Randlinie</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Lane line</source>
            <translation>Fahrstreifenlinie</translation>
        </message>
        <message>
            <location filename="../../core/common/texts.py" />
            <source>Centre line</source>
            <translation>Mittellinie</translation>
        </message>
        <message>
            <location filename="../../core/report/assessment.py" />
            <source>largest</source>
            <translation>größte</translation>
        </message>
        <message>
            <location filename="../../core/report/assessment.py" />
            <source>lateral error (cm)</source>
            <translation>Querabweichung (cm)</translation>
        </message>
        <message>
            <location filename="../../core/report/assessment.py" />
            <source>% of the length</source>
            <translation>% der Länge</translation>
        </message>
        <message>
            <location filename="../../core/report/assessment.py" />
            <source>intervals</source>
            <translation>Abschnitte</translation>
        </message>
        <message>
            <location filename="../../core/report/assessment.py" />
            <source>positive left of the reference as drawn</source>
            <translation>positiv links der Referenz, wie sie gezeichnet ist</translation>
        </message>
        <message>
            <location filename="../../core/report/assessment.py" />
            <source>along {what} (m)</source>
            <translation>längs: {what} (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/assessment.py" />
            <source>The lateral error along {what}: bars are the RMSE of every {bin:.0f} m, the line is the largest.</source>
            <translation>Die Querabweichung längs: {what}. Balken sind der RMSE von je {bin:.0f} m, die Linie ist die größte.</translation>
        </message>
        <message>
            <location filename="../../core/report/assessment.py" />
            <source>Lateral error, {signed}; what lies farther out is counted in the outermost bars.</source>
            <translation>Querabweichung, {signed}; was weiter außen liegt, zählt in den äußersten Balken.</translation>
        </message>
        <message>
            <location filename="../../core/report/assessment.py" />
            <source>Outcomes along {what}, in every {bin:.0f} m.</source>
            <translation>Ergebnisse längs: {what}, je {bin:.0f} m.</translation>
        </message>
        <message>
            <location filename="../../core/report/hd_map.py" />
            <source>{named}; and {rest} more</source>
            <translation>{named}; und {rest} weitere</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Station (m)</source>
            <translation>Station (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Offset (m)</source>
            <translation>Abstand (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>edge of the carriageway</source>
            <translation>Fahrbahnrand</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Crossfall of the lanes</source>
            <translation>Querneigung der Fahrstreifen</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Rut depth of the lanes, the deeper wheel path</source>
            <translation>Spurrinnentiefe der Fahrstreifen, die tiefere Radspur</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Width of the lanes</source>
            <translation>Breite der Fahrstreifen</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Width of the carriageway</source>
            <translation>Breite der Fahrbahn</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Grade</source>
            <translation>Längsneigung</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Height of the left curb</source>
            <translation>Höhe des linken Bords</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Height of the right curb</source>
            <translation>Höhe des rechten Bords</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Clearance</source>
            <translation>Lichte Höhe</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Rut depth, at most (mm)</source>
            <translation>Spurrinnentiefe, höchstens (mm)</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Crossfall, at least (%)</source>
            <translation>Querneigung, mindestens (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Crossfall, at most (%)</source>
            <translation>Querneigung, höchstens (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Grade, at most (%)</source>
            <translation>Längsneigung, höchstens (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Width of a lane, at least (m)</source>
            <translation>Breite eines Fahrstreifens, mindestens (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>Clearance, at least (m)</source>
            <translation>Lichte Höhe, mindestens (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/inventory.py" />
            <source>lane {number}</source>
            <translation>Fahrstreifen {number}</translation>
        </message>
        <message>
            <location filename="../../core/report/road_map.py" />
            <source>station (m)</source>
            <translation>Station (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/survey.py" />
            <source>no CRS</source>
            <translation>kein KBS</translation>
        </message>
        <message>
            <location filename="../../core/report/survey.py" />
            <source>seconds of driving, without pauses</source>
            <translation>Sekunden der Fahrt, ohne Pausen</translation>
        </message>
        <message>
            <location filename="../../core/report/survey.py" />
            <source>one sigma (m)</source>
            <translation>ein Sigma (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/survey.py" />
            <source>place</source>
            <translation>Lage</translation>
        </message>
        <message>
            <location filename="../../core/report/survey.py" />
            <source>height</source>
            <translation>Höhe</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>Files, a folder, or wildcards such as /data/B12/*.laz; or drop them here</source>
            <translation>Dateien, ein Ordner oder Platzhalter wie /data/B12/*.laz; oder hierher ziehen</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>Add point clouds</source>
            <translation>Punktwolken hinzufügen</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>Add files…</source>
            <translation>Dateien hinzufügen…</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>Add a folder…</source>
            <translation>Ordner hinzufügen…</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>Folder of point clouds</source>
            <translation>Ordner mit Punktwolken</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>no times</source>
            <translation>keine Zeiten</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>Point clouds of the project</source>
            <translation>Punktwolken des Projekts</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>There is no file {name}.</source>
            <translation>Die Datei {name} gibt es nicht.</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>1 file, {size} MB</source>
            <translation>1 Datei, {size} MB</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>{count} files, {size} MB</source>
            <translation>{count} Dateien, {size} MB</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>{count} points</source>
            <translation>{count} Punkte</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>{width} × {height} m</source>
            <translation>{width} × {height} m</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>scanned {begin} to {end} (GPS time)</source>
            <translation>gescannt {begin} bis {end} (GPS-Zeit)</translation>
        </message>
        <message>
            <location filename="../../desktop/cloud_widget.py" />
            <source>times {begin:.0f} to {end:.0f} s</source>
            <translation>Zeiten {begin:.0f} bis {end:.0f} s</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>GPS seconds since 1980</source>
            <translation>GPS-Sekunden seit 1980</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>adjusted GPS seconds</source>
            <translation>GPS-Sekunden weniger eine Milliarde (adjusted)</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>seconds of the week, most likely</source>
            <translation>wahrscheinlich Sekunden der Woche</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>seconds of the day or from the start: the point clouds tell</source>
            <translation>Sekunden des Tages oder ab dem Start: die Punktwolken zeigen es</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>left out</source>
            <translation>bleibt weg</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>time</source>
            <translation>Zeit</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>x (east)</source>
            <translation>x (Ost)</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>y (north)</source>
            <translation>y (Nord)</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>z (height)</source>
            <translation>z (Höhe)</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>roll</source>
            <translation>Rollwinkel (roll)</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>pitch</source>
            <translation>Nickwinkel (pitch)</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>heading</source>
            <translation>Kurs (heading)</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>longitude</source>
            <translation>Länge (Grad)</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>latitude</source>
            <translation>Breite (Grad)</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>time, GPS clock</source>
            <translation>Zeit, GPS-Uhr</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>time, UTC clock</source>
            <translation>Zeit, UTC-Uhr</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>GPS week</source>
            <translation>GPS-Woche</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>date</source>
            <translation>Datum</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>Recognised from the file</source>
            <translation>Aus der Datei erkannt</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>{count} positions over {length} m, heights {low:.1f} to {high:.1f} m</source>
            <translation>{count} Positionen über {length} m, Höhen {low:.1f} bis {high:.1f} m</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>no time</source>
            <translation>keine Zeit</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>{seconds:.0f} s, {speed:.0f} km/h in the median; time: {system}</source>
            <translation>{seconds:.0f} s, im Median {speed:.0f} km/h; Zeit: {system}</translation>
        </message>
        <message>
            <location filename="../../desktop/columns_widget.py" />
            <source>Column {number}</source>
            <translation>Spalte {number}</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Presets</source>
            <translation>Voreinstellungen</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Settings that you keep under a name; data and destinations are no part of them</source>
            <translation>Einstellungen, die Sie unter einem Namen behalten; Daten und Ziele gehören nicht dazu</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Folder for all results</source>
            <translation>Ordner für alle Ergebnisse</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Save as…</source>
            <translation>Speichern als…</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Default values</source>
            <translation>Vorgabewerte</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Name of the preset</source>
            <translation>Name der Voreinstellung</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Save everything to…</source>
            <translation>Alles speichern unter…</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>One place for all results: a folder with the layers as tables of one GeoPackage, images and reports beside it; or a database</source>
            <translation>Ein Ort für alle Ergebnisse: ein Ordner mit den Layern als Tabellen eines GeoPackage, Bildern und Berichten daneben; oder eine Datenbank</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Folder…</source>
            <translation>Ordner…</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Remove</source>
            <translation>Entfernen</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Database (PostGIS)…</source>
            <translation>Datenbank (PostGIS)…</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>{count} layers go to the schema {schema} of {connection}.</source>
            <translation>{count} Layer gehen in das Schema {schema} von {connection}.</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Preset {name}: {count} settings.</source>
            <translation>Voreinstellung {name}: {count} Einstellungen.</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>The {count} results go to {folder}.</source>
            <translation>Die {count} Ergebnisse gehen nach {folder}.</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/algorithm_dialog.py" />
            <source>Those of the earlier run in {file} will be replaced.</source>
            <translation>Die des früheren Laufs in {file} werden ersetzt.</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/batch_dialog.py" />
            <source>One folder for all surveys: of each the layers in one GeoPackage called like the survey, images and reports beside it</source>
            <translation>Ein Ordner für alle Vermessungen: von jeder die Layer in einem GeoPackage, das wie die Vermessung heißt, Bilder und Berichte daneben</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/batch_dialog.py" />
            <source>Folder of the surveys</source>
            <translation>Ordner der Vermessungen</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/batch_dialog.py" />
            <source>Add the surveys of a folder…</source>
            <translation>Vermessungen eines Ordners hinzufügen…</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/batch_dialog.py" />
            <source>One row for each folder with point clouds, and the trajectory that lies beside them</source>
            <translation>Eine Zeile für jeden Ordner mit Punktwolken, und die Trajektorie, die neben ihnen liegt</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/batch_dialog.py" />
            <source>Batch: {title}</source>
            <translation>Batch: {title}</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/batch_dialog.py" />
            <source>{count} surveys in {folder}.</source>
            <translation>{count} Vermessungen in {folder}.</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/batch_dialog.py" />
            <source>The results of {count} rows go to {folder}: {names}.</source>
            <translation>Die Ergebnisse von {count} Zeilen gehen nach {folder}: {names}.</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/database_dialog.py" />
            <source>Save the layers to a database</source>
            <translation>Layer in einer Datenbank speichern</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/database_dialog.py" />
            <source>such as b12_, where one schema holds several surveys</source>
            <translation>etwa b12_, wenn ein Schema mehrere Vermessungen enthält</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/database_dialog.py" />
            <source>New connection…</source>
            <translation>Neue Verbindung…</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/database_dialog.py" />
            <source>Connection</source>
            <translation>Verbindung</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/database_dialog.py" />
            <source>Schema</source>
            <translation>Schema</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/database_dialog.py" />
            <source>Names of the tables begin with</source>
            <translation>Namen der Tabellen beginnen mit</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/database_dialog.py" />
            <source>One table for each layer; a table of the same name is replaced. The intensity image and the report are files: choose a folder for them too.</source>
            <translation>Eine Tabelle je Layer; eine Tabelle desselben Namens wird ersetzt. Intensitätsbild und Bericht sind Dateien: wählen Sie für sie auch einen Ordner.</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/database_dialog.py" />
            <source>QGIS knows no connection to a PostgreSQL database yet. &lt;i&gt;New connection…&lt;/i&gt; opens the window where one is made.</source>
            <translation>QGIS kennt noch keine Verbindung zu einer PostgreSQL-Datenbank. &lt;i&gt;Neue Verbindung…&lt;/i&gt; öffnet das Fenster, in dem man eine anlegt.</translation>
        </message>
        <message>
            <location filename="../../desktop/dialogs/database_dialog.py" />
            <source>The database {name} has no schema.</source>
            <translation>Die Datenbank {name} hat kein Schema.</translation>
        </message>
        <message>
            <location filename="../../desktop/layout/layout_dialog.py" />
            <source>Print layout of the road map</source>
            <translation>Drucklayout der Straßenkarte</translation>
        </message>
        <message>
            <location filename="../../desktop/layout/layout_dialog.py" />
            <source>The largest at which the road fits; long roads on several pages</source>
            <translation>Der größte, bei dem die Straße auf das Blatt passt; lange Straßen auf mehreren Seiten</translation>
        </message>
        <message>
            <location filename="../../desktop/layout/layout_dialog.py" />
            <source>Nothing</source>
            <translation>Nichts</translation>
        </message>
        <message>
            <location filename="../../desktop/layout/layout_dialog.py" />
            <source>Whose data lie below, as their licence wants it said; stands in the lower left corner of the map</source>
            <translation>Wessen Daten darunterliegen, wie es deren Lizenz verlangt; steht in der linken unteren Ecke der Karte</translation>
        </message>
        <message>
            <location filename="../../desktop/layout/layout_dialog.py" />
            <source>Paper</source>
            <translation>Papier</translation>
        </message>
        <message>
            <location filename="../../desktop/layout/layout_dialog.py" />
            <source>Scale</source>
            <translation>Maßstab</translation>
        </message>
        <message>
            <location filename="../../desktop/layout/layout_dialog.py" />
            <source>Layer below (orthoimage, web map)</source>
            <translation>Layer darunter (Orthobild, Web-Karte)</translation>
        </message>
        <message>
            <location filename="../../desktop/layout/layout_dialog.py" />
            <source>Credit on the map</source>
            <translation>Quellenangabe auf der Karte</translation>
        </message>
        <message>
            <location filename="../../desktop/layout/map_layout.py" />
            <source>page</source>
            <translation>Seite</translation>
        </message>
        <message>
            <location filename="../../desktop/layout/map_layout.py" />
            <source>Pages of {title}</source>
            <translation>Seiten von {title}</translation>
        </message>
        <message>
            <location filename="../../desktop/manual.py" />
            <source>Contents</source>
            <translation>Inhalt</translation>
        </message>
        <message>
            <location filename="../../desktop/manual.py" />
            <source>Back</source>
            <translation>Zurück</translation>
        </message>
        <message>
            <location filename="../../desktop/manual.py" />
            <source>Forward</source>
            <translation>Vorwärts</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Road map…</source>
            <translation>Straßenkarte…</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>From a survey to driving lines in one call</source>
            <translation>Von der Vermessung zu den Fahrlinien in einem Aufruf</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Run the sample survey</source>
            <translation>Beispielvermessung ausführen</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>A simulated street through the whole chain, into this project</source>
            <translation>Eine erdachte Straße durch die ganze Kette, in dieses Projekt</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>A map of the layers that Lanewright made</source>
            <translation>Eine Karte der Layer, die Lanewright erzeugt hat</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Next doubtful place</source>
            <translation>Nächste zweifelhafte Stelle</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Goes along the road map through pieces that were not measured, that are uncertain, or where the boundary methods differ, and keeps what you decide there</source>
            <translation>Geht die Straßenkarte entlang durch Stücke, die nicht gemessen oder unsicher sind oder wo die Randverfahren voneinander abweichen, und bewahrt auf, was Sie dort entscheiden</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Cross-section</source>
            <translation>Querschnitt</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Points and lines of the road where you click in the map</source>
            <translation>Punkte und Linien der Straße, wo Sie in die Karte klicken</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Control points from paint</source>
            <translation>Passpunkte aus Markierungen</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Places UAV images on the map: the same paint in each and in the intensity image, side by side to accept or refuse</source>
            <translation>Bringt UAV-Bilder auf die Karte: dieselbe Farbe in jedem und im Intensitätsbild, nebeneinander zum Annehmen oder Ablehnen</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Open the last report</source>
            <translation>Letzten Bericht öffnen</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>The report of the run that ended last</source>
            <translation>Der Bericht des zuletzt beendeten Laufs</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Table of the runs</source>
            <translation>Tabelle der Läufe</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Lengths, shares measured, warnings, seconds and failures of all runs since QGIS was started</source>
            <translation>Längen, gemessene Anteile, Warnungen, Sekunden und Fehler aller Läufe seit dem Start von QGIS</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Replace the last run of a survey</source>
            <translation>Letzten Lauf einer Vermessung ersetzen</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>New results take the place of the last ones of the same survey and algorithm in the layer tree; files stay</source>
            <translation>Neue Ergebnisse treten im Layerbaum an die Stelle der letzten derselben Vermessung und desselben Algorithmus; Dateien bleiben</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Name files without their folders</source>
            <translation>Dateien ohne ihre Ordner nennen</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Results keep the names of the files they were made from, but not the folders; for layers that are given away</source>
            <translation>Ergebnisse behalten die Namen der Dateien, aus denen sie entstanden, aber nicht die Ordner; für Layer, die weitergegeben werden</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Manual</source>
            <translation>Handbuch</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>What every algorithm does, and a walk through a first survey</source>
            <translation>Was jeder Algorithmus tut, und ein Gang durch eine erste Vermessung</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Open a model in the designer</source>
            <translation>Ein Modell im Modelleditor öffnen</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>No report has been written since QGIS was started.</source>
            <translation>Seit dem Start von QGIS wurde noch kein Bericht geschrieben.</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>There is no road map in this project yet: run Road map, or drop the GeoPackage of one into the project.</source>
            <translation>In diesem Projekt gibt es noch keine Straßenkarte: „Straßenkarte“ ausführen oder das GeoPackage einer Straßenkarte in das Projekt ziehen.</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Run this stage again…</source>
            <translation>Diesen Schritt erneut ausführen…</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Nothing has been run since QGIS was started.</source>
            <translation>Seit dem Start von QGIS ist nichts gelaufen.</translation>
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>No web browser could be started. The report is the file {path}.</source>
            <translation>Es ließ sich kein Webbrowser starten. Der Bericht ist die Datei {path}.</translation>
        </message>
        <message>
            <location filename="../../desktop/messages.py" />
            <source>Copy command</source>
            <translation>Befehl kopieren</translation>
        </message>
        <message>
            <location filename="../../desktop/messages.py" />
            <source>How to install…</source>
            <translation>Wie installieren…</translation>
        </message>
        <message>
            <location filename="../../desktop/messages.py" />
            <source>1 warning…</source>
            <translation>1 Warnung…</translation>
        </message>
        <message>
            <location filename="../../desktop/messages.py" />
            <source>Show it</source>
            <translation>Anzeigen</translation>
        </message>
        <message>
            <location filename="../../desktop/messages.py" />
            <source>{count} warnings…</source>
            <translation>{count} Warnungen…</translation>
        </message>
        <message>
            <location filename="../../desktop/messages.py" />
            <source>{title} is done, {count} layers.</source>
            <translation>{title} ist fertig, {count} Layer.</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>not looked for yet</source>
            <translation>noch nicht gesucht</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>two points given, not looked for yet</source>
            <translation>zwei Punkte gegeben, noch nicht gesucht</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>{accepted} of {count} pairs accepted</source>
            <translation>{accepted} von {count} Paaren angenommen</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>{residual:.1f} cm off</source>
            <translation>{residual:.1f} cm daneben</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>{number}: likeness {score:.2f}, {away}</source>
            <translation>{number}: Ähnlichkeit {score:.2f}, {away}</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>looks different</source>
            <translation>sieht anders aus</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>repeats nearby</source>
            <translation>wiederholt sich daneben</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>does not fit the others</source>
            <translation>passt nicht zu den anderen</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>all of it fits elsewhere too</source>
            <translation>alles passt auch anderswo</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>Control points of {image}</source>
            <translation>Passpunkte von {image}</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/image_pairs.py" />
            <source>, RMSE {rmse:.1f} cm, each left out in turn</source>
            <translation>, RMSE {rmse:.1f} cm, jedes der Reihe nach weggelassen</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>as the image says</source>
            <translation>wie das Bild sagt</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Two points by hand…</source>
            <translation>Zwei Punkte von Hand …</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Where the chosen image says nothing of its position: two places clicked in it and in the intensity image</source>
            <translation>Wo das gewählte Bild nichts über seine Lage sagt: zwei Stellen, in ihm und im Intensitätsbild angeklickt</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Pixel size of the image on the ground</source>
            <translation>Pixelgröße des Bildes am Boden</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Add images, choose the intensity image, and let control points be proposed.</source>
            <translation>Bilder hinzufügen, das Intensitätsbild wählen und Passpunkte vorschlagen lassen.</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Georeference the images</source>
            <translation>Bilder georeferenzieren</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Add images…</source>
            <translation>Bilder hinzufügen …</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Images</source>
            <translation>Bilder</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Accept the selected</source>
            <translation>Ausgewählte annehmen</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Refuse the selected</source>
            <translation>Ausgewählte ablehnen</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Left the image, right the intensity image. A tick accepts a pair, a double click shows it on the map.</source>
            <translation>Links das Bild, rechts das Intensitätsbild. Ein Haken nimmt ein Paar an, ein Doppelklick zeigt es auf der Karte.</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>Images of a flight</source>
            <translation>Bilder einer Befliegung</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>All files</source>
            <translation>Alle Dateien</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>On the map: {file}</source>
            <translation>Auf der Karte: {file}</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/pairs_dialog.py" />
            <source>cancelled</source>
            <translation>abgebrochen</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/two_points_dialog.py" />
            <source>Two points in both images</source>
            <translation>Zwei Punkte in beiden Bildern</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/two_points_dialog.py" />
            <source>Begin again</source>
            <translation>Neu beginnen</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/two_points_dialog.py" />
            <source>Good: the places may be off by some metres.</source>
            <translation>Gut: die Stellen dürfen einige Meter falsch sein.</translation>
        </message>
        <message>
            <location filename="../../desktop/overlay/two_points_dialog.py" />
            <source>Click two places far apart in the image on the left, and the same two in the same order in the intensity image on the right. The wheel comes nearer. In the image: {seen}, in the intensity image: {known}.</source>
            <translation>Zwei weit auseinander liegende Stellen im Bild links anklicken und dieselben zwei in derselben Reihenfolge im Intensitätsbild rechts. Das Rad geht näher heran. Im Bild: {seen}, im Intensitätsbild: {known}.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/corrections_layer.py" />
            <source>{path} holds no layer of corrections. Choose a new name.</source>
            <translation>{path} enthält keinen Layer mit Korrekturen. Einen neuen Namen wählen.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/corrections_layer.py" />
            <source>The corrections cannot be kept in {path}: {problem}. Choose another place.</source>
            <translation>Die Korrekturen können nicht in {path} abgelegt werden: {problem}. Einen anderen Ort wählen.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Doubtful places</source>
            <translation>Zweifelhafte Stellen</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>The place before</source>
            <translation>Die vorige Stelle</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>The next place</source>
            <translation>Die nächste Stelle</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>The most doubtful first</source>
            <translation>Die zweifelhafteste zuerst</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Along the road</source>
            <translation>Längs der Straße</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Only what is not done</source>
            <translation>Nur was nicht erledigt ist</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>What is doubtful here. The buttons are about what is selected.</source>
            <translation>Was hier zweifelhaft ist. Die Knöpfe gelten dem, was ausgewählt ist.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Note, kept with the correction</source>
            <translation>Notiz, wird mit der Korrektur aufbewahrt</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Accept</source>
            <translation>Bestätigen</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>It is right as it is</source>
            <translation>Es ist richtig, wie es ist</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Delete</source>
            <translation>Löschen</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>There is nothing of that kind here</source>
            <translation>Hier gibt es nichts dergleichen</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Move…</source>
            <translation>Verschieben…</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Draw where it belongs, within 2 m of where it is</source>
            <translation>Zeichnen, wo es hingehört, höchstens 2 m von seinem jetzigen Ort</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Other reading</source>
            <translation>Andere Lesart</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Take the second reading of the program, which is almost as likely</source>
            <translation>Die zweite Lesart des Programms nehmen, die fast ebenso wahrscheinlich ist</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Draw</source>
            <translation>Zeichnen</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Draw what is missing</source>
            <translation>Zeichnen, was fehlt</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Take back the last</source>
            <translation>Letzte zurücknehmen</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Removes the correction that was made last</source>
            <translation>Entfernt die zuletzt gemachte Korrektur</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Make the map again…</source>
            <translation>Karte neu erstellen…</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Opens Road map with these corrections</source>
            <translation>Öffnet die Straßenkarte mit diesen Korrekturen</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>File for the corrections</source>
            <translation>Datei für die Korrekturen</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Everything</source>
            <translation>Alles</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Road edge…</source>
            <translation>Straßenrand…</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Marking line…</source>
            <translation>Markierungslinie…</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Lane, in the direction of travel…</source>
            <translation>Fahrstreifen, in Fahrtrichtung…</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Nothing of this is doubtful in the road map: all of it was measured.</source>
            <translation>Nichts davon ist in der Straßenkarte zweifelhaft: Alles wurde gemessen.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>No corrections yet.</source>
            <translation>Noch keine Korrekturen.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>A line takes two clicks at least.</source>
            <translation>Eine Linie braucht mindestens zwei Klicks.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>&lt;b&gt;Place {at} of {count}&lt;/b&gt;, {done} done; road {road}, station {station:.0f} m</source>
            <translation>&lt;b&gt;Stelle {at} von {count}&lt;/b&gt;, {done} erledigt; Straße {road}, Station {station:.0f} m</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Click along the line where it belongs. The right button ends it, Backspace takes a click back, Esc stops.</source>
            <translation>Entlang der Linie klicken, wo sie hingehört. Die rechte Taste beendet sie, die Rücktaste nimmt einen Klick zurück, Esc bricht ab.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubt_dock.py" />
            <source>Corrections in {file}: {count}. They come into the map when it is made again.</source>
            <translation>Korrekturen in {file}: {count}. Sie kommen in die Karte, wenn sie neu erstellt wird.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubtful.py" />
            <source>not measured</source>
            <translation>nicht gemessen</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubtful.py" />
            <source>the two boundary methods lie {apart:.0f} cm apart</source>
            <translation>die beiden Verfahren für die Ränder liegen {apart:.0f} cm auseinander</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubtful.py" />
            <source>confidence {sure:.2f}</source>
            <translation>Vertrauen {sure:.2f}</translation>
        </message>
        <message>
            <location filename="../../desktop/review/doubtful.py" />
            <source>; almost as likely: {reading}</source>
            <translation>; fast ebenso wahrscheinlich: {reading}</translation>
        </message>
        <message>
            <location filename="../../desktop/review/missing_parts.py" />
            <source>Road surface, {length:.0f} m: grown, no edge was found on one side at least</source>
            <translation>Straßenoberfläche, {length:.0f} m: gewachsen, auf mindestens einer Seite wurde kein Rand gefunden</translation>
        </message>
        <message>
            <location filename="../../desktop/review/missing_parts.py" />
            <source>Lane {lane} ends here, {left:.0f} m before the end of the road</source>
            <translation>Fahrstreifen {lane} endet hier, {left:.0f} m vor dem Ende der Straße</translation>
        </message>
        <message>
            <location filename="../../desktop/review/missing_parts.py" />
            <source>No road edge on the {side} for {length:.0f} m</source>
            <translation>Kein Straßenrand auf der Seite {side} über {length:.0f} m</translation>
        </message>
        <message>
            <location filename="../../desktop/review/missing_parts.py" />
            <source>Warning: {text}</source>
            <translation>Warnung: {text}</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>Click in the map</source>
            <translation>In die Karte klicken</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>Length of road from which points are shown</source>
            <translation>Länge der Straße, von der Punkte gezeigt werden</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>Click on the road in the map.</source>
            <translation>Klicken Sie in der Karte auf die Straße.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>No line of a road map lies near: click on a road that Lanewright mapped.</source>
            <translation>Keine Linie einer Straßenkarte liegt in der Nähe: Klicken Sie auf eine Straße, die Lanewright kartiert hat.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>Reading points…</source>
            <translation>Punkte werden gelesen…</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>Points of a cross-section</source>
            <translation>Punkte eines Querschnitts</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>A metre back along the road</source>
            <translation>Einen Meter zurück entlang der Straße</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>A metre ahead along the road</source>
            <translation>Einen Meter weiter entlang der Straße</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>Thickness</source>
            <translation>Dicke</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>The point clouds of this road map are not there, so only its lines are shown.</source>
            <translation>Die Punktwolken dieser Straßenkarte sind nicht da, daher werden nur ihre Linien gezeigt.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>Where is {name}? The folder of the point clouds of this road map</source>
            <translation>Wo ist {name}? Der Ordner der Punktwolken dieser Straßenkarte</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>No points lie here.</source>
            <translation>Hier liegen keine Punkte.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_dock.py" />
            <source>No points were read.</source>
            <translation>Es wurden keine Punkte gelesen.</translation>
        </message>
        <message>
            <location filename="../../desktop/review/section_view.py" />
            <source>left ← offset from the place that was clicked (m) → right; heights in m; orange: scanline; ○ bottom, △ top of a curb</source>
            <translation>links ← Abstand von der angeklickten Stelle (m) → rechts; Höhen in m; orange: Scanlinie; ○ Unter-, △ Oberkante eines Bordsteins</translation>
        </message>
        <message>
            <location filename="../../desktop/runs_window.py" />
            <source>Open in the browser</source>
            <translation>Im Browser öffnen</translation>
        </message>
        <message>
            <location filename="../../desktop/sample_run.py" />
            <source>The sample survey is being made and mapped; its layers appear when they are ready.</source>
            <translation>Die Beispielvermessung wird erzeugt und kartiert; ihre Layer erscheinen, sobald sie fertig sind.</translation>
        </message>
        <message>
            <location filename="../../desktop/sample_run.py" />
            <source>The sample survey is already running.</source>
            <translation>Die Beispielvermessung läuft bereits.</translation>
        </message>
        <message>
            <location filename="../../desktop/sample_run.py" />
            <source>The road map of the sample survey is in the project, its report in the Results Viewer. Its files in {folder} are deleted when QGIS is closed: save the layers you want to keep.</source>
            <translation>Die Straßenkarte der Beispielvermessung ist im Projekt, ihr Bericht in der Ergebnisanzeige. Ihre Dateien in {folder} werden gelöscht, wenn QGIS beendet wird: Speichern Sie die Layer, die Sie behalten möchten.</translation>
        </message>
        <message>
            <location filename="../../desktop/sample_run.py" />
            <source>The sample survey was not mapped: {reason}</source>
            <translation>Die Beispielvermessung wurde nicht kartiert: {reason}</translation>
        </message>
        <message>
            <location filename="../../library/command_line.py" />
            <source>A layer is a file (.gpkg, .fgb, .shp, .geojson), or one layer of a GeoPackage: map.gpkg|layername=lanes. A result that is not named is not made. With --json the results, or the reason of a failure, are printed as JSON; --lang de speaks German.</source>
            <translation>Ein Layer ist eine Datei (.gpkg, .fgb, .shp, .geojson) oder ein Layer eines GeoPackage: map.gpkg|layername=lanes. Ein Ergebnis, das nicht genannt ist, wird nicht erstellt. Mit --json werden die Ergebnisse, oder der Grund des Scheiterns, als JSON ausgegeben; --lang de spricht Deutsch.</translation>
        </message>
        <message>
            <location filename="../../library/command_line.py" />
            <source>Road maps from mobile laser scanning: the algorithms of Lanewright in QGIS, on files.</source>
            <translation>Straßenkarten aus mobilem Laserscanning: die Algorithmen von Lanewright in QGIS, auf Dateien.</translation>
        </message>
        <message>
            <location filename="../../library/command_line.py" />
            <source>Cancelled</source>
            <translation>Abgebrochen</translation>
        </message>
        <message>
            <location filename="../../library/command_line.py" />
            <source>inputs</source>
            <translation>Eingaben</translation>
        </message>
        <message>
            <location filename="../../library/command_line.py" />
            <source>advanced parameters</source>
            <translation>erweiterte Parameter</translation>
        </message>
        <message>
            <location filename="../../library/command_line.py" />
            <source>results</source>
            <translation>Ergebnisse</translation>
        </message>
        <message>
            <location filename="../../library/command_line.py" />
            <source>necessary</source>
            <translation>nötig</translation>
        </message>
        <message>
            <location filename="../../library/command_line.py" />
            <source>default {value}</source>
            <translation>Vorgabe {value}</translation>
        </message>
        <message>
            <location filename="../../library/command_line.py" />
            <source>{low:g} to {high:g}</source>
            <translation>{low:g} bis {high:g}</translation>
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>{label}: {file} holds neither a layer nor a table of positions. Choose the layer or the CSV, TXT or SBET file of the drive.</source>
            <translation>{label}: {file} enthält weder einen Layer noch eine Tabelle von Positionen. Den Layer oder die CSV-, TXT- oder SBET-Datei der Befahrung wählen.</translation>
        </message>
        <message>
            <location filename="../../processing_provider/call.py" />
            <source>{label}: the CRS {given} is not known. Give it as EPSG:number.</source>
            <translation>{label}: das KBS {given} ist nicht bekannt. Als EPSG:Nummer angeben.</translation>
        </message>
        <message>
            <location filename="../../processing_provider/call.py" />
            <source>{label}: {value} cannot be opened as a layer. Check the name and the folder.</source>
            <translation>{label}: {value} lässt sich nicht als Layer öffnen. Name und Ordner prüfen.</translation>
        </message>
        <message>
            <location filename="../../processing_provider/call.py" />
            <source>{label} cannot be used: {problem}</source>
            <translation>{label} kann nicht verwendet werden: {problem}</translation>
        </message>
        <message>
            <location filename="../../processing_provider/database.py" />
            <source>The result could not be written: {reason}. Is the disk full or the file open elsewhere?</source>
            <translation>Das Ergebnis konnte nicht geschrieben werden: {reason}. Ist der Datenträger voll oder die Datei anderswo geöffnet?</translation>
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source> (in the OSGeo4W Shell)</source>
            <translation> (in der OSGeo4W-Shell)</translation>
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source> (in a terminal)</source>
            <translation> (in einem Terminal)</translation>
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source>The packages go into a folder of your QGIS profile that only Lanewright looks into, after everything QGIS brings. The QPIP plugin can install them as well: it reads the requirements.txt of Lanewright.</source>
            <translation>Die Pakete kommen in einen Ordner Ihres QGIS-Profils, in den nur Lanewright schaut, nach allem, was QGIS mitbringt. Das Plugin QPIP kann sie ebenso installieren: es liest die requirements.txt von Lanewright.</translation>
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source>{missing} To install: {command}{where}. Then start QGIS again.</source>
            <translation>{missing} Zum Installieren: {command}{where}. Danach QGIS neu starten.</translation>
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source>Missing Python package(s): {names}.</source>
            <translation>Es fehlen Python-Pakete: {names}.</translation>
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source>shapely {version} is installed and version 2 or newer is needed.</source>
            <translation>shapely {version} ist installiert, gebraucht wird Version 2 oder neuer.</translation>
        </message>
        <message>
            <location filename="../../processing_provider/layers.py" />
            <source>the sink refused the features</source>
            <translation>das Ziel nahm die Objekte nicht an</translation>
        </message>
        <message>
            <location filename="../../processing_provider/models.py" />
            <source>Models</source>
            <translation>Modelle</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>along the road</source>
            <translation>mit der Straße</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>against the road</source>
            <translation>gegen die Straße</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>not driven</source>
            <translation>nicht befahren</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>bottom</source>
            <translation>unten</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>top</source>
            <translation>oben</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>drawn by hand</source>
            <translation>von Hand gezeichnet</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>take the second reading</source>
            <translation>die zweite Lesart nehmen</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>another reading</source>
            <translation>eine andere Lesart</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>station</source>
            <translation>Station</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>Road edge</source>
            <translation>Fahrbahnrand</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>Lane</source>
            <translation>Fahrstreifen</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>Paint</source>
            <translation>Farbe</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>Pass</source>
            <translation>Befahrung</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>Curb point</source>
            <translation>Bordsteinpunkt</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/attributes.py" />
            <source>a lane of {width:.1f} m {direction}</source>
            <translation>ein Fahrstreifen von {width:.1f} m {direction}</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/ready_styles.py" />
            <source>By class</source>
            <translation>Nach Klasse</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/ready_styles.py" />
            <source>By status</source>
            <translation>Nach Status</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/ready_styles.py" />
            <source>By confidence</source>
            <translation>Nach Vertrauen</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/run_table.py" />
            <source>Begun</source>
            <translation>Begonnen</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/run_table.py" />
            <source>Duration (s)</source>
            <translation>Dauer (s)</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/run_table.py" />
            <source>Failed</source>
            <translation>Gescheitert</translation>
        </message>
        <message>
            <location filename="../../processing_provider/results/runs.py" />
            <source>Lanewright</source>
            <translation>Lanewright</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/assessment.html" />
            <source>{result} against {reference}.</source>
            <translation>{result} gegen {reference}.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Accuracy of road boundaries</source>
            <translation>Genauigkeit der Straßenränder</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Judged in intervals of {interval:g} m along {along}, each side by itself. An interval is correct when lines of the result cover at least {coverage:g} % of it and {agreement:g} % of them lie within the tolerance of the reference. A line elsewhere is false, and the reference is missed; so it is where there is no line, whether something hid the boundary or not. Tolerances are distances to either side.</source>
            <translation>Beurteilt in Abschnitten von {interval:g} m längs: {along}; jede Seite für sich. Ein Abschnitt ist richtig, wenn Linien des Ergebnisses mindestens {coverage:g} % davon abdecken und {agreement:g} % von ihnen innerhalb der Toleranz der Referenz liegen. Eine Linie anderswo ist falsch und die Referenz übersehen; ebenso, wo keine Linie ist, ob nun etwas den Rand verdeckt hat oder nicht. Toleranzen sind Abstände nach jeder Seite.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Side</source>
            <translation>Seite</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Tolerance (cm)</source>
            <translation>Toleranz (cm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Intervals</source>
            <translation>Abschnitte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Correct</source>
            <translation>Richtig</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Missed</source>
            <translation>Übersehen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>False</source>
            <translation>Falsch</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Not judged: {count} intervals.</source>
            <translation>Nicht beurteilt: {count} Abschnitte.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>{length:.1f} m of the result lie more than {corridor:g} m from the trajectory and were left out.</source>
            <translation>{length:.1f} m des Ergebnisses liegen mehr als {corridor:g} m von der Trajektorie entfernt und wurden weggelassen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Not judged because</source>
            <translation>Nicht beurteilt, weil</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Errors in the correct intervals</source>
            <translation>Abweichungen in den richtigen Abschnitten</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Across: mean (cm)</source>
            <translation>Quer: Mittel (cm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Maximum (cm)</source>
            <translation>Größter Wert (cm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Height: mean (cm)</source>
            <translation>Höhe: Mittel (cm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>The mean across is {signed}; heights are result less reference, and missing where a layer has none.</source>
            <translation>Das Mittel quer ist {signed}; Höhen sind Ergebnis weniger Referenz und fehlen, wo ein Layer keine hat.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/boundary_accuracy.html" />
            <source>Intervals by outcome; north is up. Correct, missed and excluded ones are drawn along the reference, false ones along the result.</source>
            <translation>Abschnitte nach Ergebnis; Norden ist oben. Richtige, übersehene und ausgenommene sind längs der Referenz gezeichnet, falsche längs des Ergebnisses.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Stations count along the road, offsets to its left. Crossfall is positive where the road falls to the right, seen along the road; left and right are seen that way too.</source>
            <translation>Stationen zählen längs der Straße, Abstände nach links. Die Querneigung ist positiv, wo die Straße nach rechts fällt, längs der Straße gesehen; auch links und rechts sind so gesehen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Limits</source>
            <translation>Grenzwerte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>no limit</source>
            <translation>kein Grenzwert</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Of the country: {sources}</source>
            <translation>Vom Land: {sources}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>The country of the catalogue sets no limits.</source>
            <translation>Das Land des Katalogs setzt keine Grenzwerte.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>What exceeds the limits</source>
            <translation>Was die Grenzwerte überschreitet</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Limit</source>
            <translation>Grenzwert</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>From (m)</source>
            <translation>Von (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>To (m)</source>
            <translation>Bis (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Worst</source>
            <translation>Schlechtester Wert</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>No section exceeds a limit.</source>
            <translation>Kein Querschnitt überschreitet einen Grenzwert.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>{count} more are in the layer (field exceeds).</source>
            <translation>{count} weitere stehen im Layer (Feld exceeds).</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Road {road}</source>
            <translation>Straße {road}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Part</source>
            <translation>Teil</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Width (m)</source>
            <translation>Breite (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Crossfall (%)</source>
            <translation>Querneigung (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Grade (%)</source>
            <translation>Längsneigung (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Rut left (mm)</source>
            <translation>Spurrinne links (mm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Rut right (mm)</source>
            <translation>Spurrinne rechts (mm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>Medians along the road. ± is the standard deviation of a crossfall, with what roll leaves unknown.</source>
            <translation>Mediane längs der Straße. ± ist die Standardabweichung einer Querneigung, einschließlich dessen, was der Rollwinkel offenlässt.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/cross_sections.html" />
            <source>The lanes from above, straightened. Red: a limit is exceeded.</source>
            <translation>Die Fahrstreifen von oben, begradigt. Rot: Ein Grenzwert ist überschritten.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Accuracy of driving lines</source>
            <translation>Genauigkeit der Fahrlinien</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Tolerances were given as the total width of the buffer; the half-width stands beside it.</source>
            <translation>Toleranzen wurden als ganze Breite des Puffers angegeben; die halbe steht daneben.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Tolerances were given as the half-width of the buffer, from the line to its rim.</source>
            <translation>Toleranzen wurden als halbe Breite des Puffers angegeben, von der Linie zu seinem Rand.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Completeness (recall) is the share of the reference within the tolerance of the result; correctness (precision) the share of the result within the tolerance of the reference, and miscoding the share outside it: the buffer lies about the reference. Quality is matched result over result and unmatched reference.</source>
            <translation>Vollständigkeit ist der Anteil der Referenz innerhalb der Toleranz des Ergebnisses; Richtigkeit (Präzision) der Anteil des Ergebnisses innerhalb der Toleranz der Referenz, Fehlkodierung der Anteil außerhalb: Der Puffer liegt um die Referenz. Qualität ist zugeordnetes Ergebnis durch Ergebnis und nicht zugeordnete Referenz.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Lines that cross at more than {angle:g}° do not match.</source>
            <translation>Linien, die sich unter mehr als {angle:g}° kreuzen, passen nicht zusammen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Lines match whatever their direction.</source>
            <translation>Linien passen zusammen, welche Richtung sie auch haben.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Half-width (cm)</source>
            <translation>Halbe Breite (cm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Total width (cm)</source>
            <translation>Ganze Breite (cm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Mean gap (m)</source>
            <translation>Mittlere Lücke (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>{result:.1f} m of result, {reference:.1f} m of reference. A gap is at least {gap:g} m of reference without a result within the tolerance.</source>
            <translation>{result:.1f} m Ergebnis, {reference:.1f} m Referenz. Eine Lücke ist mindestens {gap:g} m Referenz ohne ein Ergebnis innerhalb der Toleranz.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Errors</source>
            <translation>Abweichungen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Mean (cm)</source>
            <translation>Mittel (cm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Across</source>
            <translation>Quer</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Height</source>
            <translation>Höhe</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Of the result within {distance:.0f} cm of a reference line. The mean across is positive left of the reference as drawn.</source>
            <translation>Vom Ergebnis innerhalb von {distance:.0f} cm um eine Referenzlinie. Das Mittel quer ist positiv links der Referenz, wie sie gezeichnet ist.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Line by line</source>
            <translation>Linie für Linie</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Reference line</source>
            <translation>Referenzlinie</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Recall {tolerance:g} cm (%)</source>
            <translation>Vollständigkeit {tolerance:g} cm (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Miscoding {tolerance:g} cm (%)</source>
            <translation>Fehlkodierung {tolerance:g} cm (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>Half-widths. Each reference line with the result that lies nearest to it; result farther than {distance:.0f} cm from every reference line belongs to none and shows in the table above only.</source>
            <translation>Halbe Breiten. Jede Referenzlinie mit dem Ergebnis, das ihr am nächsten liegt; Ergebnis, das weiter als {distance:.0f} cm von jeder Referenzlinie entfernt ist, gehört zu keiner und steht nur in der Tabelle oben.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/driving_accuracy.html" />
            <source>The result's lines, correct and false, and the reference where it was missed; north is up.</source>
            <translation>Die Linien des Ergebnisses, richtig und falsch, und die Referenz, wo sie übersehen wurde; Norden ist oben.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Estimated trajectory</source>
            <translation>Geschätzte Trajektorie</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Where the scanner was, from the point clouds alone.</source>
            <translation>Wo der Scanner war, allein aus den Punktwolken.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>{median:.3f} m (median), {largest:.3f} m (largest)</source>
            <translation>{median:.3f} m (Median), {largest:.3f} m (größte)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Way</source>
            <translation>Weg</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>from {what}</source>
            <translation>aus: {what}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Length</source>
            <translation>Länge</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Time</source>
            <translation>Zeit</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>{first:.3f} to {last:.3f} s</source>
            <translation>{first:.3f} bis {last:.3f} s</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Refers to</source>
            <translation>Bezieht sich auf</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>the middle of the scanners</source>
            <translation>die Mitte der Scanner</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>the scanner</source>
            <translation>den Scanner</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Uncertainty of the place, one sigma</source>
            <translation>Unsicherheit der Lage, ein Sigma</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Uncertainty of the height, one sigma</source>
            <translation>Unsicherheit der Höhe, ein Sigma</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Scanner</source>
            <translation>Scanner</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Turns per second</source>
            <translation>Umdrehungen je Sekunde</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Plane turned (°)</source>
            <translation>Ebene verdreht (°)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Plane leaning forward (°)</source>
            <translation>Ebene nach vorn geneigt (°)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Ahead (m)</source>
            <translation>Vorn (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Left (m)</source>
            <translation>Links (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Up (m)</source>
            <translation>Oben (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Returns off their rays (mm)</source>
            <translation>Echos neben ihren Strahlen (mm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Turned: counter-clockwise from straight across. Ahead, left and up: from the middle of the scanners.</source>
            <translation>Verdreht: gegen den Uhrzeigersinn aus der Querrichtung. Vorn, links und oben: von der Mitte der Scanner aus.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Uncertainty along the drive</source>
            <translation>Unsicherheit längs der Fahrt</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/estimated_trajectory.html" />
            <source>Blue the place, orange the height, one sigma. It grows at the ends of the cloud, where few lines see the road.</source>
            <translation>Blau die Lage, orange die Höhe, ein Sigma. Sie wächst an den Enden der Wolke, wo wenige Linien die Straße sehen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>How well the image lies on its control points.</source>
            <translation>Wie gut das Bild auf seinen Passpunkten liegt.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>shift (order 0)</source>
            <translation>Verschiebung (Ordnung 0)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>polynomial of order 1 (affine)</source>
            <translation>Polynom der Ordnung 1 (affin)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>polynomial of order 2</source>
            <translation>Polynom der Ordnung 2</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>polynomial of order 3</source>
            <translation>Polynom der Ordnung 3</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Pixels and lines</source>
            <translation>Pixel und Zeilen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Placed by</source>
            <translation>Eingepasst durch</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Result</source>
            <translation>Ergebnis</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>{width} × {height} pixels of {size:g} m</source>
            <translation>{width} × {height} Pixel von {size:g} m</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Drawn within</source>
            <translation>Gezeichnet innerhalb von</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>{departure:.2f} pixels of the polynomial, everywhere</source>
            <translation>{departure:.2f} Pixeln vom Polynom, überall</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Outside the hull of the control points</source>
            <translation>Außerhalb der Hülle der Passpunkte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>{share:.0f} % of the image, left out</source>
            <translation>{share:.0f} % des Bildes, weggelassen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>{share:.0f} % of the image</source>
            <translation>{share:.0f} % des Bildes</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>RMSE (pixels)</source>
            <translation>RMSE (Pixel)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Control points, each left out in turn</source>
            <translation>Passpunkte, jeder der Reihe nach weggelassen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>RMSE = √(Σ(dx² + dy²) / n). The residuals of control points are too small, since the polynomial was fitted to them; there are {free} more than it needs. Points measured in the laser point cloud itself show how well the image fits the cloud, not how well either fits the ground.</source>
            <translation>RMSE = √(Σ(dx² + dy²) / n). Die Restklaffungen der Passpunkte sind zu klein, denn das Polynom wurde an sie angepasst; es gibt {free} mehr, als es braucht. Punkte, die in der Laserpunktwolke selbst gemessen sind, zeigen, wie gut das Bild zur Wolke passt, nicht, wie gut eines von beiden zum Boden passt.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>From where the polynomial puts each point to where it was measured, {times} times as long as on the ground. North is up; the thin line is the hull of the control points.</source>
            <translation>Von dort, wohin das Polynom jeden Punkt setzt, dorthin, wo er gemessen wurde, {times}-mal so lang wie am Boden. Norden ist oben; die dünne Linie ist die Hülle der Passpunkte.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Point</source>
            <translation>Punkt</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Role</source>
            <translation>Rolle</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Pixel</source>
            <translation>Pixel</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Line, downwards</source>
            <translation>Zeile, nach unten</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>East (m)</source>
            <translation>Ost (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>North (m)</source>
            <translation>Nord (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Residual (m)</source>
            <translation>Restabweichung (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/georeferencing.html" />
            <source>Without this point (m)</source>
            <translation>Ohne diesen Punkt (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>What the point clouds and the trajectory hold, before any work is done on them.</source>
            <translation>Was die Punktwolken und die Trajektorie enthalten, bevor damit gearbeitet wird.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Files</source>
            <translation>Dateien</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Extent</source>
            <translation>Ausdehnung</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>{width:.1f} × {depth:.1f} m, {height:.1f} m high</source>
            <translation>{width:.1f} × {depth:.1f} m, {height:.1f} m hoch</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>{low:.2f} to {high:.2f}</source>
            <translation>{low:.2f} bis {high:.2f}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Returns</source>
            <translation>Echos</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Classes</source>
            <translation>Klassen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Density</source>
            <translation>Dichte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Points per m²</source>
            <translation>Punkte je m²</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Points per m³</source>
            <translation>Punkte je m³</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Mean of occupied cells</source>
            <translation>Mittel der besetzten Zellen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Median of occupied cells</source>
            <translation>Median der besetzten Zellen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>As a point sees it (mean over points)</source>
            <translation>Wie ein Punkt sie sieht (Mittel über die Punkte)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Densest cell</source>
            <translation>Dichteste Zelle</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Points per m², from 0 (dark) to {most:.0f} (yellow); north is up.</source>
            <translation>Punkte je m², von 0 (dunkel) bis {most:.0f} (gelb); Norden ist oben.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Red is the trajectory.</source>
            <translation>Rot ist die Trajektorie.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Time and scanners</source>
            <translation>Zeit und Scanner</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>{first:.3f} to {last:.3f} s, {seconds:.1f} s</source>
            <translation>{first:.3f} bis {last:.3f} s, {seconds:.1f} s</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Counted as</source>
            <translation>Gezählt als</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>adjusted standard GPS time; begins {start} in GPS time</source>
            <translation>GPS-Standardzeit weniger eine Milliarde Sekunden; beginnt {start} in GPS-Zeit</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>seconds of the GPS week, says the file</source>
            <translation>Sekunden der GPS-Woche, laut Datei</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>none that can be used</source>
            <translation>keine verwendbare</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>{count}, distinguished by {field}</source>
            <translation>{count}, unterschieden durch {field}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Points within 25 m of the trajectory</source>
            <translation>Punkte innerhalb von 25 m der Trajektorie</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Scan time covered by the trajectory</source>
            <translation>Von der Trajektorie abgedeckte Scanzeit</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>{count} positions over {length:.1f} m</source>
            <translation>{count} Positionen über {length:.1f} m</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Drive</source>
            <translation>Fahrt</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>road {number}: {length:.1f} m</source>
            <translation>Straße {number}: {length:.1f} m</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Driven</source>
            <translation>Gefahren</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>unknown: too few points lie under the vehicle</source>
            <translation>unbekannt: zu wenige Punkte liegen unter dem Fahrzeug</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>{height:.2f} m above the road</source>
            <translation>{height:.2f} m über der Straße</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>From station (m)</source>
            <translation>Von Station (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>To station (m)</source>
            <translation>Bis Station (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Seconds</source>
            <translation>Sekunden</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Mean speed (km/h)</source>
            <translation>Mittlere Geschwindigkeit (km/h)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>along</source>
            <translation>mit</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>against</source>
            <translation>gegen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Heights along the drive, {length:.0f} m from left to right, {low:.1f} m (below) to {high:.1f} m (above): red the trajectory, grey the road under it.</source>
            <translation>Höhen längs der Fahrt, {length:.0f} m von links nach rechts, {low:.1f} m (unten) bis {high:.1f} m (oben): rot die Trajektorie, grau die Straße darunter.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Intensity</source>
            <translation>Intensität</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Range</source>
            <translation>Bereich</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>{low} to {high}</source>
            <translation>{low} bis {high}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>1 %, median, 99 %</source>
            <translation>1 %, Median, 99 %</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Different values</source>
            <translation>Verschiedene Werte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>How often each intensity occurs, from {low} (left) to {high} (right).</source>
            <translation>Wie oft jede Intensität vorkommt, von {low} (links) bis {high} (rechts).</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>File</source>
            <translation>Datei</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/inspection.html" />
            <source>Point format</source>
            <translation>Punktformat</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/intensity_correction.html" />
            <source>Intensity correction</source>
            <translation>Intensitätskorrektur</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/intensity_correction.html" />
            <source>Asphalt's intensity by scanner, before and after. Distances are from the track of the vehicle.</source>
            <translation>Die Intensität des Asphalts nach Scanner, vorher und nachher. Entfernungen sind die von der Spur des Fahrzeugs.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/intensity_correction.html" />
            <source>Asphalt before</source>
            <translation>Asphalt vorher</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/intensity_correction.html" />
            <source>Asphalt after</source>
            <translation>Asphalt nachher</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/intensity_correction.html" />
            <source>Variation before (%)</source>
            <translation>Schwankung vorher (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/intensity_correction.html" />
            <source>Variation after (%)</source>
            <translation>Schwankung nachher (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/intensity_correction.html" />
            <source>Highest/lowest before</source>
            <translation>Höchster/niedrigster vorher</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/intensity_correction.html" />
            <source>Highest/lowest after</source>
            <translation>Höchster/niedrigster nachher</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/map_check.html" />
            <source>Check of an HD map</source>
            <translation>Prüfung einer HD-Karte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/map_check.html" />
            <source>Nothing was found.</source>
            <translation>Es wurde nichts gefunden.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/map_check.html" />
            <source>Faults</source>
            <translation>Fehler</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/map_check.html" />
            <source>What it means</source>
            <translation>Was er bedeutet</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/map_check.html" />
            <source>One row for the same finding at many places, those at the fewest places first; what was seen is the largest. The layer has a point for each place, with its row.</source>
            <translation>Eine Zeile für denselben Befund an vielen Stellen, die an den wenigsten Stellen zuerst; gesehen ist der größte. Der Layer hat einen Punkt je Stelle, mit seiner Zeile.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/map_check.html" />
            <source>Row</source>
            <translation>Zeile</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/map_check.html" />
            <source>Where</source>
            <translation>Wo</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/map_check.html" />
            <source>What was seen</source>
            <translation>Was gesehen wurde</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/map_export.html" />
            <source>The file as it is read back</source>
            <translation>Die Datei, wie sie zurückgelesen wird</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/map_export.html" />
            <source>Lanes by type and painted lines; north is up.</source>
            <translation>Fahrstreifen nach Art und aufgemalte Linien; Norden ist oben.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Accuracy of markings</source>
            <translation>Genauigkeit der Markierungen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>{count} cell</source>
            <translation>{count} Zelle</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>{count} cells</source>
            <translation>{count} Zellen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Judged in cells of {size:g} cm; a cell is painted when its centre is. With a tolerance of one cell the other side is widened by one cell all round before the comparison. An object is found, or right, if at least {share:g} % of its cells are, with a tolerance of {cells}.</source>
            <translation>Beurteilt in Zellen von {size:g} cm; eine Zelle ist markiert, wenn ihre Mitte es ist. Mit einer Toleranz von einer Zelle wird die andere Seite vor dem Vergleich ringsum um eine Zelle verbreitert. Ein Objekt ist gefunden oder richtig, wenn mindestens {share:g} % seiner Zellen es sind, mit einer Toleranz von {cells}.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Right</source>
            <translation>Richtig</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Objects</source>
            <translation>Objekte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Cells, strict</source>
            <translation>Zellen, streng</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Cells, tolerance {cells}</source>
            <translation>Zellen, Toleranz {cells}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>With a tolerance and for objects, IoU is F1 / (2 − F1): right cells of the result and found ones of the reference differ in number.</source>
            <translation>Mit Toleranz und bei Objekten ist IoU = F1 / (2 − F1): Die Zahl der richtigen Zellen des Ergebnisses und die der gefundenen der Referenz unterscheiden sich.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>within {cells} (%)</source>
            <translation>innerhalb von {cells} (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Class</source>
            <translation>Klasse</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Reference cells</source>
            <translation>Zellen der Referenz</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Result cells</source>
            <translation>Zellen des Ergebnisses</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>F1 of the class (%)</source>
            <translation>F1 der Klasse (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>IoU of the class (%)</source>
            <translation>IoU der Klasse (%)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Recall and precision count paint of any class; F1 and IoU of the class require the same class in both, if both have it.</source>
            <translation>Vollständigkeit und Präzision zählen Farbe jeder Klasse; F1 und IoU der Klasse verlangen in beiden dieselbe Klasse, wo beide eine haben.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>Objects of the reference that were found and missed, and false objects of the result; north is up.</source>
            <translation>Gefundene und übersehene Objekte der Referenz und falsche Objekte des Ergebnisses; Norden ist oben.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/marking_accuracy.html" />
            <source>With a tolerance of {cells}.</source>
            <translation>Mit einer Toleranz von {cells}.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/parts.html" />
            <source>Map</source>
            <translation>Karte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/parts.html" />
            <source>Map, within {tolerance:g} cm</source>
            <translation>Karte, innerhalb von {tolerance:g} cm</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/parts.html" />
            <source>The bar is {length:g} m long.</source>
            <translation>Der Balken ist {length:g} m lang.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/parts.html" />
            <source>Distribution</source>
            <translation>Verteilung</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>Proposed control points</source>
            <translation>Vorgeschlagene Passpunkte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>The same paint in the image and in the intensity image.</source>
            <translation>Dieselbe Farbe im Bild und im Intensitätsbild.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>Placed roughly by</source>
            <translation>Ungefähr eingepasst durch</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>Found turned by</source>
            <translation>Gefunden mit Drehung</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>{turn:.1f}° counter-clockwise, from its rows to east</source>
            <translation>{turn:.1f}° gegen den Uhrzeigersinn, von seinen Zeilen nach Osten</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>Pixel on the ground</source>
            <translation>Pixel am Boden</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>Pairs</source>
            <translation>Paare</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>{count}, of which {accepted} accepted</source>
            <translation>{count}, davon {accepted} angenommen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>RMSE of the accepted pairs, each left out in turn</source>
            <translation>RMSE der angenommenen Paare, jedes der Reihe nach weggelassen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>{rmse:.3f} m, by a polynomial of order {order}</source>
            <translation>{rmse:.3f} m, durch ein Polynom der Ordnung {order}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>The next likely place lies {away:.1f} m away: {here:.0f} corners speak for the place found, {there:.0f} for that one.</source>
            <translation>Die nächstwahrscheinliche Stelle liegt {away:.1f} m entfernt: {here:.0f} Ecken sprechen für die gefundene Stelle, {there:.0f} für jene.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>Pairs of cut-outs</source>
            <translation>Paare von Ausschnitten</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>Left the image, right the intensity image, both 3.2 m wide, north up. Green: accepted. Red: refused by default. Below each: its number, the likeness of the two, and how far off the other pairs place it.</source>
            <translation>Links das Bild, rechts das Intensitätsbild, beide 3,2 m breit, Norden oben. Grün: angenommen. Rot: in der Vorgabe abgelehnt. Unter jedem: seine Nummer, die Ähnlichkeit der beiden, und wie weit daneben die anderen Paare es setzen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>Accepted</source>
            <translation>Bestätigt</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>Likeness</source>
            <translation>Ähnlichkeit</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>Why not</source>
            <translation>Warum nicht</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>yes</source>
            <translation>ja</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/proposed_points.html" />
            <source>no</source>
            <translation>nein</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Made by Lanewright. Lengths are in metres; “bridged” was drawn across a gap, “inferred” was placed from the outer lines alone; everything else was measured.</source>
            <translation>Erstellt von Lanewright. Längen sind in Metern; „überbrückt“ wurde über eine Lücke hinweg gezeichnet, „erschlossen“ allein aus den äußeren Linien; alles andere wurde gemessen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>The uncertainty is one sigma across the line, from residuals, point spacing and what passes differ by; two thirds of the places lie within it on simulated streets. What the whole trajectory is off is not in it.</source>
            <translation>Die Unsicherheit ist ein Sigma quer zur Linie, aus Restabweichungen, Punktabstand und dem, worin Befahrungen sich unterscheiden; auf simulierten Straßen liegen zwei Drittel der Stellen innerhalb davon. Ein Fehler der ganzen Trajektorie ist nicht darin.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>The road map over the intensity image; north is up.</source>
            <translation>Die Straßenkarte über dem Intensitätsbild; Norden ist oben.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>road edge, measured</source>
            <translation>Straßenrand, gemessen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>road edge, bridged</source>
            <translation>Straßenrand, überbrückt</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>the two methods more than 5 cm apart</source>
            <translation>die beiden Verfahren mehr als 5 cm auseinander</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>marking line</source>
            <translation>Markierungslinie</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>{height:.2f} m (pass {number})</source>
            <translation>{height:.2f} m (Befahrung {number})</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Points read</source>
            <translation>Gelesene Punkte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Points near the road</source>
            <translation>Punkte nahe der Straße</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Passes</source>
            <translation>Befahrungen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Trajectory above the road</source>
            <translation>Trajektorie über der Straße</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Per m³, mean of occupied cubes</source>
            <translation>Je m³, Mittel der besetzten Würfel</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Per m³, as a point sees it</source>
            <translation>Je m³, wie ein Punkt sie sieht</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Before: points near the road</source>
            <translation>Vorher: Punkte nahe der Straße</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>After: road surface</source>
            <translation>Nachher: Straßenoberfläche</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Cubes of 1 m. {share:.1f} % of the points near the road are its surface. “As a point sees it” is the mean over points of how many share their cube.</source>
            <translation>Würfel von 1 m. {share:.1f} % der Punkte nahe der Straße sind ihre Oberfläche. „Wie ein Punkt sie sieht“ ist das Mittel über die Punkte, wie viele sich ihren Würfel teilen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Road edges and surface</source>
            <translation>Straßenränder und Oberfläche</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Edge</source>
            <translation>Rand</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Status</source>
            <translation>Status</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Uncertainty (mm)</source>
            <translation>Unsicherheit (mm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Neither a curb nor an edge of the pavement was found along this road, so no edge line was drawn.</source>
            <translation>Längs dieser Straße wurde weder ein Bordstein noch ein Rand der Befestigung gefunden; daher wurde keine Randlinie gezeichnet.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Agreement of the two methods</source>
            <translation>Übereinstimmung der beiden Verfahren</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Edges measured (m)</source>
            <translation>Gemessene Ränder (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Both methods see {length:.0f} m of the edges drawn; 95 % of each piece keeps within {usual:.1f} cm on average.</source>
            <translation>Beide Verfahren sehen {length:.0f} m der gezeichneten Ränder; 95 % jedes Stücks liegen im Mittel innerhalb von {usual:.1f} cm.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Here they lie more than 5 cm apart; look at these places first.</source>
            <translation>Hier liegen sie mehr als 5 cm auseinander; diese Stellen zuerst ansehen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Apart at most (cm)</source>
            <translation>Auseinander, höchstens (cm)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Nowhere do they lie more than 5 cm apart for a metre or more.</source>
            <translation>Nirgends liegen sie einen Meter oder länger mehr als 5 cm auseinander.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Status of the surface</source>
            <translation>Status der Oberfläche</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Area (m²)</source>
            <translation>Fläche (m²)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>{taken} points were taken for paint, {kept} are left without outliers.</source>
            <translation>{taken} Punkte galten als Farbe, {kept} bleiben ohne Ausreißer.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Use</source>
            <translation>Verwendung</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Number</source>
            <translation>Anzahl</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Line</source>
            <translation>Linie</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Pattern</source>
            <translation>Muster</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Mean curvature of marking points (1/m)</source>
            <translation>Mittlere Krümmung von Markierungspunkten (1/m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Before fitting</source>
            <translation>Vor dem Einpassen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>After fitting</source>
            <translation>Nach dem Einpassen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>kernel of 0.2 m, {count} points</source>
            <translation>Kern von 0,2 m, {count} Punkte</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Absolute mean curvature of the surface through the points of line markings, as measured and at the height of the line fitted to them: how rough a marking is, not how the road bends.</source>
            <translation>Betrag der mittleren Krümmung der Fläche durch die Punkte von Linienmarkierungen, wie gemessen und in der Höhe der eingepassten Linie: wie rau eine Markierung ist, nicht, wie die Straße sich krümmt.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>No driving line was made: no two lines that bound a lane were found.</source>
            <translation>Es wurde keine Fahrlinie erstellt: Keine zwei Linien wurden gefunden, die einen Fahrstreifen begrenzen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Source</source>
            <translation>Herkunft</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Turn</source>
            <translation>Drehsinn</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>The driving lines have no circular arcs.</source>
            <translation>Die Fahrlinien haben keine Kreisbögen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Curvature along the driving lines</source>
            <translation>Krümmung längs der Fahrlinien</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Road {road}, lane {lane}.</source>
            <translation>Straße {road}, Fahrstreifen {lane}.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Lane {lane}.</source>
            <translation>Fahrstreifen {lane}.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>the line as drawn</source>
            <translation>die Linie, wie gezeichnet</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>arcs of the table of curve elements</source>
            <translation>Bögen der Tabelle der Bogenelemente</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>least radius for the speed, {code}</source>
            <translation>kleinster Radius für die Geschwindigkeit, {code}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>In 1/m, in the direction of travel, positive to the left; from the headings of the {base:g} m behind and ahead. Stations are the road's.</source>
            <translation>In 1/m, in Fahrtrichtung, positiv nach links; aus den Richtungen der {base:g} m davor und danach. Stationen sind die der Straße.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>{count} further driving lines are not drawn.</source>
            <translation>{count} weitere Fahrlinien sind nicht gezeichnet.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Design code check, {code}</source>
            <translation>Prüfung nach Entwurfsregel, {code}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>less than {speed}</source>
            <translation>unter {speed}</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Allows (km/h)</source>
            <translation>Erlaubt (km/h)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Why</source>
            <translation>Warum</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Speed (km/h)</source>
            <translation>Geschwindigkeit (km/h)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Least radius (m)</source>
            <translation>Kleinster Radius (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Least length of a curve (m)</source>
            <translation>Kleinste Länge einer Kurve (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Corrections that match nothing in this run and were left out: {count}. Look at these places and delete or renew the rows.</source>
            <translation>Korrekturen, die in diesem Lauf zu nichts passen und weggelassen wurden: {count}. Diese Stellen ansehen und die Zeilen löschen oder erneuern.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Action</source>
            <translation>Aktion</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Target</source>
            <translation>Ziel</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Note</source>
            <translation>Notiz</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Reading and placing points</source>
            <translation>Punkte lesen und zuordnen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Curbs</source>
            <translation>Bordsteine</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Marking extraction</source>
            <translation>Markierungen extrahieren</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Outlier removal</source>
            <translation>Ausreißer entfernen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Clustering</source>
            <translation>Zusammenfassen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Stage</source>
            <translation>Schritt</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/road_map.html" />
            <source>Together</source>
            <translation>Zusammen</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/roadside.html" />
            <source>What stands beside the road. Heights are those above the ground at its foot; distances count outward from the carriageway's edge.</source>
            <translation>Was neben der Straße steht. Höhen sind die über dem Boden am Fuß; Abstände zählen vom Fahrbahnrand nach außen.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/roadside.html" />
            <source>Single</source>
            <translation>Einzelnes</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/roadside.html" />
            <source>Nothing was found within the reach.</source>
            <translation>In der Reichweite wurde nichts gefunden.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/roadside.html" />
            <source>The roadside from above, straightened; black are the edges of the carriageway.</source>
            <translation>Der Straßenseitenraum von oben, begradigt; schwarz sind die Fahrbahnränder.</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/roadside.html" />
            <source>Kind</source>
            <translation>Art</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/roadside.html" />
            <source>From the edge (m)</source>
            <translation>Vom Rand (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/roadside.html" />
            <source>Height (m)</source>
            <translation>Höhe (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/roadside.html" />
            <source>Foot (m)</source>
            <translation>Fuß (m)</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/runs.html" />
            <source>Runs of Lanewright</source>
            <translation>Läufe von Lanewright</translation>
        </message>
        <message>
            <location filename="../../core/report/templates/runs.html" />
            <source>since QGIS was started</source>
            <translation>seit dem Start von QGIS</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Pass that drove nearest</source>
            <translation>Befahrung, die am nächsten fuhr</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Side (left/right)</source>
            <translation>Seite (left/right)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Confidence (0 to 1)</source>
            <translation>Vertrauen (0 bis 1)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Second reading that is almost as probable (JSON)</source>
            <translation>Zweite Lesart, die fast ebenso wahrscheinlich ist (JSON)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Offset, left positive (m)</source>
            <translation>Abstand, links positiv (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Part (bottom/top)</source>
            <translation>Teil (bottom/top)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Agreement of the two methods (cm)</source>
            <translation>Übereinstimmung der beiden Verfahren (cm)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Radius (m)</source>
            <translation>Radius (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Kind (main/corner/side_street/island)</source>
            <translation>Art (main/corner/side_street/island)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>RMSE of the fit (m)</source>
            <translation>RMSE der Einpassung (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Uncertainty across, one sigma (m)</source>
            <translation>Unsicherheit quer, ein Sigma (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Part of the uncertainty across that all lines of the road share, from trajectory and passes (m)</source>
            <translation>Anteil der Querunsicherheit, den alle Linien der Straße teilen, aus Trajektorie und Befahrungen (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Edge (curb/dropped/pavement)</source>
            <translation>Rand (curb/dropped/pavement)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>End station (m)</source>
            <translation>Endstation (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Distance from the carriageway's edge (m)</source>
            <translation>Abstand vom Fahrbahnrand (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Outcome (correct/missed/false/excluded)</source>
            <translation>Ergebnis (correct/missed/false/excluded)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Chain along the curb</source>
            <translation>Kette längs des Bordsteins</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Distance along the chain (m)</source>
            <translation>Entfernung längs der Kette (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Supporting points</source>
            <translation>Stützende Punkte</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Interval of the planes (m)</source>
            <translation>Abstand der Ebenen (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Cluster</source>
            <translation>Gruppe</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Use (keep/other)</source>
            <translation>Verwendung (keep/other)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Elongation</source>
            <translation>Längung</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Scanning distance (m)</source>
            <translation>Scanentfernung (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Kind (edge/lane/centre)</source>
            <translation>Art (edge/lane/centre)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Curve</source>
            <translation>Kurve</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Fitted function (JSON)</source>
            <translation>Eingepasste Funktion (JSON)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Lines to its left|right</source>
            <translation>Linien links|rechts davon</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Direction (1 along, -1 against the road)</source>
            <translation>Richtung (1 mit, -1 gegen die Straße)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Source (pair/offset)</source>
            <translation>Herkunft (pair/offset)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Lane and piece (road.lane.piece)</source>
            <translation>Fahrstreifen und Stück (Straße.Streifen.Stück)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Type (driving/shoulder/parking/bicycle/hatched/median/connector)</source>
            <translation>Art (driving/shoulder/parking/bicycle/hatched/median/connector)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Direction (1 along, -1 against the road, 0 not driven)</source>
            <translation>Richtung (1 mit, -1 gegen die Straße, 0 nicht befahren)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>What its left border is (line N of the marking lines, edge N: chain of the road edges)</source>
            <translation>Was ihr linker Rand ist (line N der Markierungslinien, edge N: chain der Straßenränder)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>What its right border is (line N of the marking lines, edge N: chain of the road edges)</source>
            <translation>Was ihr rechter Rand ist (line N der Markierungslinien, edge N: chain der Straßenränder)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Kind of its left border</source>
            <translation>Art der linken Begrenzung</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Kind of its right border</source>
            <translation>Art der rechten Begrenzung</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Pattern of its left border</source>
            <translation>Muster der linken Begrenzung</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Pattern of its right border</source>
            <translation>Muster der rechten Begrenzung</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Lanes that follow, by lane_id</source>
            <translation>Folgende Fahrstreifen, nach lane_id</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Turn (left/right)</source>
            <translation>Drehsinn (left/right)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>R (m)</source>
            <translation>R (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>R (ft)</source>
            <translation>R (ft)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Δ (°)</source>
            <translation>Δ (°)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>D (° per 100 ft)</source>
            <translation>D (° je 100 ft)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>D (° per 100 m)</source>
            <translation>D (° je 100 m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>L (m)</source>
            <translation>L (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>L (ft)</source>
            <translation>L (ft)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>T (m)</source>
            <translation>T (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>T (ft)</source>
            <translation>T (ft)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>M (m)</source>
            <translation>M (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>M (ft)</source>
            <translation>M (ft)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>LC (m)</source>
            <translation>LC (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>LC (ft)</source>
            <translation>LC (ft)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>E (m)</source>
            <translation>E (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>E (ft)</source>
            <translation>E (ft)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>RMSE of the arc (m)</source>
            <translation>RMSE des Bogens (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Highest design speed allowed (km/h)</source>
            <translation>Höchste erlaubte Entwurfsgeschwindigkeit (km/h)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Design code check</source>
            <translation>Prüfung nach Entwurfsregel</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Action (accept/delete/move/draw/take)</source>
            <translation>Aktion (accept/delete/move/draw/take)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>What is meant (edge/marking/lane)</source>
            <translation>Was gemeint ist (edge/marking/lane)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Kind of a line that is drawn (edge/lane/centre)</source>
            <translation>Art einer gezeichneten Linie (edge/lane/centre)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Pattern of a line that is drawn (solid/dashed)</source>
            <translation>Muster einer gezeichneten Linie (solid/dashed)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Second reading that is taken (JSON)</source>
            <translation>Zweite Lesart, die genommen wird (JSON)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Road, lane, way or relation</source>
            <translation>Straße, Fahrstreifen, Weg oder Relation</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Row of the report</source>
            <translation>Zeile des Berichts</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Places with the same finding</source>
            <translation>Stellen mit demselben Befund</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Section</source>
            <translation>Querschnitt</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Part (carriageway/lane)</source>
            <translation>Teil (carriageway/lane)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Type of the lane</source>
            <translation>Art des Fahrstreifens</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Direction (1 along, -1 against the road, 0 not known)</source>
            <translation>Richtung (1 mit, -1 gegen die Straße, 0 unbekannt)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Offset of its middle, left positive (m)</source>
            <translation>Abstand seiner Mitte, links positiv (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Borders taken from (lanes/lines/edges/track)</source>
            <translation>Grenzen aus (lanes/lines/edges/track)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Crossfall, positive falls to the right along the road (%)</source>
            <translation>Querneigung, positiv fällt längs der Straße nach rechts (%)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Sigma of the crossfall, roll included (%)</source>
            <translation>Sigma der Querneigung mit Rollwinkel (%)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Grade, positive climbs along the road (%)</source>
            <translation>Längsneigung, positiv steigt längs der Straße (%)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Rut depth, left wheel path (mm)</source>
            <translation>Spurrinnentiefe, linke Radspur (mm)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Rut depth, right wheel path (mm)</source>
            <translation>Spurrinnentiefe, rechte Radspur (mm)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Height of the left curb (m)</source>
            <translation>Höhe des linken Bords (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Height of the right curb (m)</source>
            <translation>Höhe des rechten Bords (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Clearance above (m)</source>
            <translation>Lichte Höhe (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Surface seen (%)</source>
            <translation>Gesehene Oberfläche (%)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Limits not kept</source>
            <translation>Nicht eingehaltene Grenzwerte</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Kind (guard_rail/barrier/wall/fence/hedge/gutter)</source>
            <translation>Art (guard_rail/barrier/wall/fence/hedge/gutter)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Height of its top above the ground, of a gutter its depth (m)</source>
            <translation>Höhe der Oberkante über dem Boden, einer Rinne ihre Tiefe (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Height of its lower edge above the ground (m)</source>
            <translation>Höhe der Unterkante über dem Boden (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Kind (pole/sign/trunk)</source>
            <translation>Art (pole/sign/trunk)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Height of its top above the ground (m)</source>
            <translation>Höhe der Spitze über dem Boden (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Diameter of its shaft (m)</source>
            <translation>Durchmesser des Schafts (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Role (control/check/disabled)</source>
            <translation>Rolle (control/check/disabled)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Residual east (m)</source>
            <translation>Restklaffung Ost (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Residual north (m)</source>
            <translation>Restklaffung Nord (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Residual without this point (m)</source>
            <translation>Restklaffung ohne diesen Punkt (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Leverage (0 to 1)</source>
            <translation>Hebelwirkung (0 bis 1)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Role (control/check)</source>
            <translation>Rolle (control/check)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>What was pointed at</source>
            <translation>Worauf gezeigt wurde</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Accepted (1/0)</source>
            <translation>Angenommen (1/0)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Likeness of the two cut-outs (0 to 1)</source>
            <translation>Ähnlichkeit der beiden Ausschnitte (0 bis 1)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Distance from where the other pairs place it (m)</source>
            <translation>Abstand von da, wo die anderen Paare es hinlegen (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Why it is not accepted</source>
            <translation>Warum es nicht angenommen ist</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Time (s)</source>
            <translation>Zeit (s)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Roll (°)</source>
            <translation>Rollwinkel (°)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Pitch (°)</source>
            <translation>Nickwinkel (°)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Heading (°, clockwise from grid north)</source>
            <translation>Kurs (°, im Uhrzeigersinn von Gitternord)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Uncertainty of the place, one sigma (m)</source>
            <translation>Unsicherheit der Lage, ein Sigma (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Uncertainty of the height, one sigma (m)</source>
            <translation>Unsicherheit der Höhe, ein Sigma (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Begins (s, clock of the point clouds)</source>
            <translation>Beginnt (s, Uhr der Punktwolken)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Ends (s, clock of the point clouds)</source>
            <translation>Endet (s, Uhr der Punktwolken)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Road, or line of the reference</source>
            <translation>Straße, oder Linie der Referenz</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Covered by the result (m)</source>
            <translation>Vom Ergebnis abgedeckt (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Row of the line in its layer</source>
            <translation>Zeile der Linie in ihrem Layer</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>From, along the line (m)</source>
            <translation>Von, längs der Linie (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>To, along the line (m)</source>
            <translation>Bis, längs der Linie (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Mean distance (m)</source>
            <translation>Mittlerer Abstand (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Largest distance (m)</source>
            <translation>Größter Abstand (m)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Of (reference/result)</source>
            <translation>Aus (reference/result)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Share of it in the other layer (%)</source>
            <translation>Anteil davon im anderen Layer (%)</translation>
        </message>
        <message>
            <location filename="../../core/common/features.py" />
            <source>Judged area (m²)</source>
            <translation>Beurteilte Fläche (m²)</translation>
        </message>
        <message>
            <location filename="../../tools/models.py" />
            <source>Road map stages</source>
            <translation>Straßenkarte in Schritten</translation>
        </message>
        <message>
            <location filename="../../tools/models.py" />
            <source>The stages of the road map, one by one, with their results handed on through files: the same result as Road map. Copy it and change a stage to your needs.</source>
            <translation>Die Stufen der Straßenkarte, eine nach der anderen, deren Ergebnisse über Dateien weitergereicht werden: dasselbe Ergebnis wie „Straßenkarte“. Kopieren und eine Stufe nach Bedarf ändern.</translation>
        </message>
        <message>
            <location filename="../../tools/models.py" />
            <source>Scanline boundary stages</source>
            <translation>Fahrbahnränder aus Scanlinien in Schritten</translation>
        </message>
        <message>
            <location filename="../../tools/models.py" />
            <source>Road boundaries alone, by normalized scanlines: the measured surface is cut by planes across the road, and bottom and top of the curb are the corners of the planes fitted to it.</source>
            <translation>Nur Straßenränder, über normalisierte Scanlinien: Die gemessene Oberfläche wird quer zur Straße von Ebenen geschnitten; Unter- und Oberkante des Bordsteins sind die Ecken der eingepassten Ebenen.</translation>
        </message>
        <message>
            <location filename="../../tools/models.py" />
            <source>Markings and driving lines with assessment</source>
            <translation>Markierungen und Fahrlinien mit Bewertung</translation>
        </message>
        <message>
            <location filename="../../tools/models.py" />
            <source>The road map, and how its markings and driving lines compare with reference layers of your own: reports, and layers coloured by outcome.</source>
            <translation>Die Straßenkarte, und wie ihre Markierungen und Fahrlinien zu eigenen Referenzlayern passen: Berichte und Layer, gefärbt nach Ergebnis.</translation>
        </message>
        <message>
            <location filename="../../tools/models.py" />
            <source>Survey to HD map</source>
            <translation>Von der Vermessung zur HD-Karte</translation>
        </message>
        <message>
            <location filename="../../tools/models.py" />
            <source>The road map, and the same lanes as OpenDRIVE and Lanelet2 files.</source>
            <translation>Die Straßenkarte und dieselben Fahrstreifen als OpenDRIVE- und Lanelet2-Dateien.</translation>
        </message>
        <message>
            <location filename="../../resources/styles/assessed_lines.qml" />
            <source>Not judged</source>
            <translation>Nicht bewertet</translation>
        </message>
        <message>
            <location filename="../../resources/styles/boundaries.qml" />
            <source>Left, measured</source>
            <translation>Links, gemessen</translation>
        </message>
        <message>
            <location filename="../../resources/styles/boundaries.qml" />
            <source>Left, bridged</source>
            <translation>Links, überbrückt</translation>
        </message>
        <message>
            <location filename="../../resources/styles/boundaries.qml" />
            <source>Left, inferred</source>
            <translation>Links, erschlossen</translation>
        </message>
        <message>
            <location filename="../../resources/styles/boundaries.qml" />
            <source>Left, hidden</source>
            <translation>Links, verdeckt</translation>
        </message>
        <message>
            <location filename="../../resources/styles/boundaries.qml" />
            <source>Right, measured</source>
            <translation>Rechts, gemessen</translation>
        </message>
        <message>
            <location filename="../../resources/styles/boundaries.qml" />
            <source>Right, bridged</source>
            <translation>Rechts, überbrückt</translation>
        </message>
        <message>
            <location filename="../../resources/styles/boundaries.qml" />
            <source>Right, inferred</source>
            <translation>Rechts, erschlossen</translation>
        </message>
        <message>
            <location filename="../../resources/styles/boundaries.qml" />
            <source>Right, hidden</source>
            <translation>Rechts, verdeckt</translation>
        </message>
        <message>
            <location filename="../../resources/styles/corrections.qml" />
            <source>To be deleted</source>
            <translation>Zu löschen</translation>
        </message>
        <message>
            <location filename="../../resources/styles/corrections.qml" />
            <source>Moved here</source>
            <translation>Hierher verschoben</translation>
        </message>
        <message>
            <location filename="../../resources/styles/corrections.qml" />
            <source>Drawn</source>
            <translation>Gezeichnet</translation>
        </message>
        <message>
            <location filename="../../resources/styles/corrections.qml" />
            <source>Second reading taken</source>
            <translation>Zweite Lesart genommen</translation>
        </message>
        <message>
            <location filename="../../resources/styles/cross_sections.qml" />
            <source>A limit is exceeded</source>
            <translation>Ein Grenzwert ist überschritten</translation>
        </message>
        <message>
            <location filename="../../resources/styles/cross_sections.qml" />
            <source>Carriageway</source>
            <translation>Fahrbahn</translation>
        </message>
        <message>
            <location filename="../../resources/styles/driving_lines.qml" />
            <source>Measured</source>
            <translation>Gemessen</translation>
        </message>
        <message>
            <location filename="../../resources/styles/driving_lines.qml" />
            <source>Bridged</source>
            <translation>Überbrückt</translation>
        </message>
        <message>
            <location filename="../../resources/styles/driving_lines.qml" />
            <source>Inferred</source>
            <translation>Erschlossen</translation>
        </message>
        <message>
            <location filename="../../resources/styles/marking_lines.qml" />
            <source>Solid</source>
            <translation>Durchgezogen</translation>
        </message>
        <message>
            <location filename="../../resources/styles/marking_lines.qml" />
            <source>Dashed</source>
            <translation>Gestrichelt</translation>
        </message>
        <message>
            <location filename="../../resources/styles/markings.qml" />
            <source>Other paint</source>
            <translation>Andere Farbe</translation>
        </message>
        <message>
            <location filename="../../resources/styles/proposed_points.qml" />
            <source>Not accepted</source>
            <translation>Nicht angenommen</translation>
        </message>
        <message>
            <location filename="../../resources/styles/residuals.qml" />
            <source>Control point (residual × 100)</source>
            <translation>Passpunkt (Restklaffung × 100)</translation>
        </message>
        <message>
            <location filename="../../resources/styles/residuals.qml" />
            <source>Check point (residual × 100)</source>
            <translation>Prüfpunkt (Restklaffung × 100)</translation>
        </message>
        <message>
            <location filename="../../resources/styles/road_edges.qml" />
            <source>Edge of the pavement, no curb</source>
            <translation>Rand der Befestigung, kein Bordstein</translation>
        </message>
        <message>
            <location filename="../../resources/styles/road_edges.qml" />
            <source>Edge of the pavement, bridged</source>
            <translation>Rand der Befestigung, überbrückt</translation>
        </message>
        <message>
            <location filename="../../resources/styles/road_surface.qml" />
            <source>Between edges</source>
            <translation>Zwischen den Rändern</translation>
        </message>
        <message>
            <location filename="../../resources/styles/road_surface.qml" />
            <source>Grown, no edge</source>
            <translation>Gewachsen, ohne Rand</translation>
        </message>
        <message>
            <location filename="../../resources/styles/roadside.qml" />
            <source>Guard rail</source>
            <translation>Leitplanke</translation>
        </message>
        <message>
            <location filename="../../resources/styles/roadside.qml" />
            <source>Concrete barrier</source>
            <translation>Betonschutzwand</translation>
        </message>
        <message>
            <location filename="../../resources/styles/roadside.qml" />
            <source>Fence</source>
            <translation>Zaun</translation>
        </message>
        <message>
            <location filename="../../resources/styles/roadside.qml" />
            <source>Hedge</source>
            <translation>Hecke</translation>
        </message>
        <message>
            <location filename="../../resources/styles/roadside_objects.qml" />
            <source>Pole</source>
            <translation>Mast</translation>
        </message>
        <message>
            <location filename="../../resources/styles/roadside_objects.qml" />
            <source>Sign</source>
            <translation>Schild</translation>
        </message>
    </context>
</TS>
